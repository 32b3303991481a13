// Puts ImGui's triangles on the screen through the renderer's own GL functions.
#pragma once

#include <imgui.h>

#include "render/gl/object.hpp"
#include "render/gl/program.hpp"
#include "render/renderer.hpp"

namespace understudy::ui {

/// A picture for ImGui::Image: a GL texture's name. Texture 0 is the font atlas.
inline ImTextureID texture_id(unsigned gl_name) {
  return reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(gl_name));
}

/// Draws finished frames. Make, use and destroy it with one context current.
class DrawPass {
 public:
  DrawPass();
  /// Draws over what is in the target, colours as they are (sRGB). Uploads the atlas when its pixels are not
  /// those of the last call. Throws Error where the context's complaints are fatal.
  void draw(const ImDrawData& data, const ImFontAtlas& atlas, const render::Target& target);

 private:
  void upload_atlas(const ImFontAtlas& atlas);
  void upload_lists(const ImDrawData& data);
  void draw_commands(const ImDrawData& data, render::PixelSize size);

  render::gl::Program program_;
  render::gl::Uniform<Eigen::Vector2f> to_clip_;
  render::gl::VertexArray vertex_array_;
  render::gl::Buffer vertices_, indices_;
  render::gl::Texture atlas_;
  const void* atlas_pixels_ = nullptr;  ///< which atlas `atlas_` shows
};

}  // namespace understudy::ui
