#include "ui/gui/fonts.hpp"

#include <imgui_freetype.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string>

#include "retarget/base/log.hpp"

namespace understudy::ui {
namespace {

constexpr float kBody = 16, kSmall = 14, kTitle = 23;  // line heights in pixels at scale 1

// Latin, Greek, Cyrillic, and the signs of captions, units and keys.
constexpr ImWchar kWords[] = {0x20,   0xFF,   0x100,  0x17F,  0x370,  0x3FF,  0x400,  0x45F,  0x2010, 0x2027,
                              0x2032, 0x2033, 0x2070, 0x2089, 0x2190, 0x2193, 0x21E7, 0x21E7, 0x2206, 0x2206,
                              0x2212, 0x2212, 0x221E, 0x221E, 0x2248, 0x2248, 0x2260, 0x2265, 0};

std::string first_existing(std::initializer_list<const char*> paths) {
  for (const char* path : paths)
    if (std::filesystem::exists(path)) return path;
  return {};
}

std::string regular_file() {
  return first_existing({"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                         "/usr/share/fonts/truetype/inter/Inter-Regular.ttf",
                         "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"});
}

std::string strong_file() {
  return first_existing({"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                         "/usr/share/fonts/truetype/inter/Inter-SemiBold.ttf",
                         "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"});
}

ImFont* add(ImFontAtlas& atlas, const std::string& file, float size) {
  ImFontConfig config;
  config.PixelSnapH = true;
  config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  if (!file.empty())
    if (ImFont* font = atlas.AddFontFromFileTTF(file.c_str(), size, &config, kWords)) return font;
  log::warn_once("no font found (fonts-inter): the interface uses a plain one");
  config.SizePixels = std::round(size * 0.8f);
  return atlas.AddFontDefault(&config);
}

/// Gives every digit the widest digit's advance, each in the middle of it.
void make_digits_equal(ImFont& font) {
  float widest = 0;
  for (ImWchar c = '0'; c <= '9'; ++c) widest = std::max(widest, font.GetCharAdvance(c));
  for (ImFontGlyph& glyph : font.Glyphs) {
    if (glyph.Codepoint < '0' || glyph.Codepoint > '9') continue;
    const float shift = std::floor((widest - glyph.AdvanceX) / 2);
    glyph.X0 += shift, glyph.X1 += shift, glyph.AdvanceX = widest;
  }
  font.BuildLookupTable();
}

}  // namespace

Fonts load_fonts(ImFontAtlas& atlas, float scale) {
  const std::string regular = regular_file(), strong = strong_file();
  const auto size = [scale](float at_one) { return std::round(at_one * scale); };
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.Flags |= ImFontAtlasFlags_NoMouseCursors;
  Fonts fonts;
  fonts.body = add(atlas, regular, size(kBody));
  fonts.strong = add(atlas, strong, size(kBody));
  fonts.title = add(atlas, strong, size(kTitle));
  fonts.small = add(atlas, regular, size(kSmall));
  atlas.Build();
  for (ImFont* font : atlas.Fonts) make_digits_equal(*font);
  return fonts;
}

}  // namespace understudy::ui
