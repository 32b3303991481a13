// One pane: what it shows, its picture on the graphics card, and when that must be drawn again.
#pragma once

#include "render/gl/object.hpp"
#include "render/renderer.hpp"
#include "ui/viewport/hand.hpp"
#include "ui/viewport/pane_pictures.hpp"
#include "ui/viewport/scene_builder.hpp"

namespace understudy::ui {

/// A picture that is drawn into and shown by ImGui.
class PaneCanvas {
 public:
  /// Whether it shows this already, as good as it was asked for then.
  bool shows(const render::Scene& scene, const render::Camera& camera, render::PixelSize size) const;
  /// `fine`: as good as the settings say; else a sketch, for while things move.
  void draw(render::Renderer& renderer, const render::Scene& scene, const render::Camera& camera,
            render::PixelSize size, bool fine);
  bool fine() const { return fine_; }
  /// Its name for ImGui::Image; upside down, as OpenGL has it.
  unsigned texture() const { return texture_.name(); }
  void forget() { drawn_ = false; }

 private:
  void resize(render::PixelSize size);

  render::gl::Texture texture_;
  render::gl::Framebuffer framebuffer_;
  render::PixelSize size_;
  render::Scene scene_;  ///< kept whole: its arrays keep their addresses
  render::Camera camera_;
  bool drawn_ = false, fine_ = false;
};

struct Pane {
  PaneContent content;
  PaneView view;
  PictureKeeper keeper;
  ColourMemory colours;
  PaneScene made;
  EditPreview preview;
  PaneCanvas canvas;
};

/// The figure under the pointer where a surface shows figures: "12.4 mm", "left knee 0.83"; else empty.
std::string value_under(const app::Session& session, const Pane& pane, const ImVec2& at);
/// The place on a pane's surface under the pointer.
std::optional<Vec3> surface_place(const app::Session& session, const Pane& pane, const ImVec2& at);

}  // namespace understudy::ui
