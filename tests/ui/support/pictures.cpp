#include "tests/ui/support/pictures.hpp"

#include <array>
#include <cstring>
#include <set>

#include "render/gl/scopes.hpp"

namespace understudy::ui {
namespace {

using GlyphRect = std::array<float, 4>;  // u0, v0, u1, v1

std::set<GlyphRect> glyph_places(const ImFontAtlas& atlas) {
  std::set<GlyphRect> places;
  for (const ImFont* font : atlas.Fonts)
    for (const ImFontGlyph& glyph : font->Glyphs) places.insert({glyph.U0, glyph.V0, glyph.U1, glyph.V1});
  return places;
}

bool is_cut(const ImDrawVert& from, const ImDrawVert& to, const std::set<GlyphRect>& glyphs,
            const Rect& seen) {
  if (from.uv.x == to.uv.x || from.uv.y == to.uv.y) return false;  // a line or an area
  if (from.col >> IM_COL32_A_SHIFT == 0) return false;
  if (glyphs.count({from.uv.x, from.uv.y, to.uv.x, to.uv.y}) == 0) return true;
  return from.pos.x < seen.min.x - 1 || from.pos.y < seen.min.y - 1 || to.pos.x > seen.max.x + 1 ||
         to.pos.y > seen.max.y + 1;
}

}  // namespace

std::vector<Rect> cut_letters(const ImDrawData& data, const ImFontAtlas& atlas) {
  const std::set<GlyphRect> glyphs = glyph_places(atlas);
  const Rect display{{0, 0}, data.DisplaySize};
  std::vector<Rect> cut;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.GetTexID() != nullptr) continue;
      const Rect seen = intersection(
          display, {{command.ClipRect.x, command.ClipRect.y}, {command.ClipRect.z, command.ClipRect.w}});
      const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
      for (unsigned k = 0; k + 6 <= command.ElemCount; k += 3) {
        const bool quad = index[k + 3] == index[k] && index[k + 4] == index[k + 2];  // 0 1 2, 0 2 3
        const ImDrawVert &from = list.VtxBuffer[static_cast<int>(command.VtxOffset + index[k])],
                         &to = list.VtxBuffer[static_cast<int>(command.VtxOffset + index[k + 2])];
        if (quad && is_cut(from, to, glyphs, seen)) cut.push_back({from.pos, to.pos});
      }
    }
  }
  return cut;
}

render::Image picture(render::PixelSize size, const std::function<void(const render::RenderTarget&)>& draw) {
  namespace gl = render::gl;
  const gl::Framebuffer framebuffer;
  const gl::Texture texture;
  gl::api().BindTexture(GL_TEXTURE_2D, texture.name());
  gl::api().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       nullptr);
  const gl::TargetScope target(framebuffer.name(), size.width, size.height);
  gl::api().FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
  gl::api().ClearColor(0, 0, 0, 1);
  gl::api().Clear(GL_COLOR_BUFFER_BIT);
  draw({framebuffer.name(), size});
  render::Image upside_down(size.width, size.height), image(size.width, size.height);
  gl::api().PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl::api().ReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.pixels.data());
  for (int y = 0; y < size.height; ++y)
    std::memcpy(image.at(0, y), upside_down.at(0, size.height - 1 - y), static_cast<size_t>(size.width) * 3);
  return image;
}

render::Image picture(DrawPass& pass, const ImDrawData& data, const ImFontAtlas& atlas,
                      render::PixelSize size) {
  return picture(size, [&](const render::RenderTarget& target) {
    pass.present(data, atlas, target, {0, 0, 0, 1});
  });
}

}  // namespace understudy::ui
