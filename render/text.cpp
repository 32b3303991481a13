#include "render/text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

namespace understudy::render {

struct Font::Face {
  std::vector<unsigned char> bytes;
  stbtt_fontinfo info;
};

namespace {

/// The code points of UTF-8; an invalid byte stands for itself.
std::vector<int> code_points(const std::string& text) {
  std::vector<int> points;
  for (size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i++]);
    const int more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC0 ? 1 : 0;
    int point = more == 0 ? byte : byte & (0x3F >> more);
    for (int k = 0; k < more && i < text.size(); ++k) point = (point << 6) | (text[i++] & 0x3F);
    points.push_back(point);
  }
  return points;
}

/// Calls visit(code point, x) for each letter; returns the width.
template <class Visit>
float lay_out(const stbtt_fontinfo& info, const std::string& text, float scale, Visit visit) {
  float x = 0;
  int before = 0;
  for (const int point : code_points(text)) {
    if (before != 0) x += scale * static_cast<float>(stbtt_GetCodepointKernAdvance(&info, before, point));
    visit(point, x);
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&info, point, &advance, &bearing);
    x += scale * static_cast<float>(advance);
    before = point;
  }
  return x;
}

/// A letter's coverage, 0..255.
struct Glyph {
  int width, height;
  std::vector<unsigned char> coverage;
};

void blend(Image& image, const Glyph& glyph, int left, int top, const Vec3& color) {
  for (int y = std::max(0, -top); y < std::min(glyph.height, image.height - top); ++y)
    for (int x = std::max(0, -left); x < std::min(glyph.width, image.width - left); ++x) {
      const float a = static_cast<float>(glyph.coverage[static_cast<size_t>(y) * glyph.width + x]) / 255;
      uint8_t* pixel = image.at(left + x, top + y);
      for (int c = 0; c < 3; ++c)
        pixel[c] =
            static_cast<uint8_t>(std::lround((1 - a) * static_cast<float>(pixel[c]) + a * 255 * color[c]));
    }
}

}  // namespace

Font::Font(const std::string& path) {
  const std::string bytes = read_file(path);
  auto face = std::make_shared<Face>();
  face->bytes.assign(bytes.begin(), bytes.end());
  const bool tables = face->bytes.size() > 12 && stbtt_GetFontOffsetForIndex(face->bytes.data(), 0) == 0;
  US_CHECK(tables && stbtt_InitFont(&face->info, face->bytes.data(), 0) != 0, path, ": not a font");
  face_ = std::move(face);
}

Font Font::system() {
  for (const char* path : {"/usr/share/fonts/opentype/inter/Inter-Medium.otf",
                           "/usr/share/fonts/truetype/inter/Inter-Medium.ttf",
                           "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"})
    if (std::filesystem::exists(path)) return Font(path);
  log::warn_once("no font found (fonts-inter): pictures have no captions");
  return Font();
}

float Font::width(const std::string& text, float size) const {
  if (!found()) return 0;
  return lay_out(face_->info, text, stbtt_ScaleForMappingEmToPixels(&face_->info, size), [](int, float) {});
}

void Font::draw(Image& image, const std::string& text, const Eigen::Vector2f& at, float size,
                const Vec3& color) const {
  if (!found()) return;
  const stbtt_fontinfo& info = face_->info;
  const float scale = stbtt_ScaleForMappingEmToPixels(&info, size);
  lay_out(info, text, scale, [&](int point, float offset) {
    const float x = at.x() + offset, y = at.y(), shift = x - std::floor(x);
    int left, top, right, bottom;
    stbtt_GetCodepointBitmapBoxSubpixel(&info, point, scale, scale, shift, 0, &left, &top, &right, &bottom);
    if (right <= left || bottom <= top) return;
    Glyph glyph{right - left, bottom - top, {}};
    glyph.coverage.resize(static_cast<size_t>(glyph.width) * glyph.height);
    stbtt_MakeCodepointBitmapSubpixel(&info, glyph.coverage.data(), glyph.width, glyph.height, glyph.width,
                                      scale, scale, shift, 0, point);
    blend(image, glyph, static_cast<int>(std::floor(x)) + left, static_cast<int>(std::lround(y)) + top,
          color);
  });
}

}  // namespace understudy::render
