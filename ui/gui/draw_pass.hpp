// Draws ImGui's triangles with the renderer's GL functions.
#pragma once

#include <imgui.h>

#include <vector>

#include "render/gl/object.hpp"
#include "render/gl/program.hpp"
#include "render/renderer.hpp"
#include "ui/gui/damage.hpp"

namespace understudy::ui {

/// A picture for ImGui::Image: a GL texture's name. Where its tint is opaque it covers what is below,
/// whatever its own opacity. Texture 0 is the font atlas.
inline ImTextureID texture_id(unsigned gl_name) {
  return reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(gl_name));
}

/// Draws finished frames. Make, use and destroy it with one context current.
class DrawPass {
 public:
  DrawPass();
  /// Makes the target show the frame over `backdrop`, colours as they are (sRGB), by drawing only what
  /// differs from the frame presented before. Pictures other than the atlas count as different each time.
  /// Uploads the atlas when its pixels are new. Throws Error where the context's messages are fatal.
  void present(const ImDrawData& data, const ImFontAtlas& atlas, const render::RenderTarget& target,
               const ImVec4& backdrop);

 private:
  struct Call {  // one draw call, inside one rectangle
    unsigned texture;
    Rect clip;
    bool blend;
    size_t first_index;
    int count, first_vertex;
  };
  void upload_atlas(const ImFontAtlas& atlas);
  void upload_vertices(const ImDrawData& data);
  void collect(const ImDrawData& data, const Rect& rect);
  void collect(const ImDrawList& list, const ImDrawCmd& command, const Rect& clip, int first_vertex);
  void draw_rects(const ImDrawData& data, const std::vector<Rect>& rects);
  void issue(size_t from, size_t to);

  render::gl::Program program_;
  render::gl::Uniform<Eigen::Vector2f> to_clip_;
  render::gl::VertexArray vertex_array_;
  render::gl::Buffer vertices_, indices_;
  render::gl::Texture atlas_, canvas_;
  render::gl::Framebuffer framebuffer_;
  render::PixelSize canvas_size_;
  const void* atlas_pixels_ = nullptr;  ///< which atlas `atlas_` shows
  Damage damage_;
  ImVec4 backdrop_{-1, -1, -1, -1};
  std::vector<Call> calls_;
  std::vector<ImDrawIdx> all_indices_;
};

}  // namespace understudy::ui
