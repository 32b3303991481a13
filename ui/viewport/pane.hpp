// One pane: what it shows, its picture on the graphics card, and when to draw it again.
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
  /// Whether it already shows this in at least this quality.
  bool shows(const render::Scene& scene, const render::Camera& camera, render::PixelSize size) const;
  /// `fine`: in the quality of the settings; else a quick draft while things move.
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
