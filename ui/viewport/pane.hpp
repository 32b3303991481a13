// One pane: its frames from the cache, its picture on the graphics card, and what is under the pointer.
#pragma once

#include <deque>
#include <optional>

#include "render/gl/object.hpp"
#include "render/picking.hpp"
#include "render/renderer.hpp"
#include "ui/viewport/flat_canvas.hpp"
#include "ui/viewport/scene_builder.hpp"

namespace understudy::ui {

/// Everything that a pane needs for a frame, requested at once; none while a part is being made. Does not
/// wait for ghosts: takes those that are ready.
std::optional<PanePictures> pictures_of(const app::Session& session, app::FrameCache& cache,
                                        const PaneContent& pane, int frame);
/// Whether all ghosts of a pane's pictures are made.
bool ghosts_ready(const app::Session& session, const PaneContent& pane, const PanePictures& pictures);
/// Requests the next frames of playback, or the neighbours of a still frame.
void prefetch(const app::Session& session, app::FrameCache& cache, const PaneContent& pane);

/// The looks of a pane's targets, as pane.takes; null where they are being made.
std::vector<std::shared_ptr<const TargetLook>> looks_of(const app::Session& session, TargetLooks& looks,
                                                        const PaneContent& pane);
/// The look of a pane's first target where the pane shows its T-pose, or the mesh as loaded, instead of a
/// frame (null while it is being made); else none.
std::optional<std::shared_ptr<const TargetLook>> unposed_look(const app::Session& session, TargetLooks& looks,
                                                              const PaneContent& pane);

/// How that target is seen: the look's own picture, or in its rest pose while that is edited; null while it
/// is being made.
std::shared_ptr<const app::PosedPicture> rest_picture(const app::Session& session, app::FrameCache& cache,
                                                      const PaneContent& pane, const TargetLook& look);

/// Keeps the last frames until the next are ready.
class PictureKeeper {
 public:
  /// What to show now: the current frame, or the newest requested frame that is ready.
  const PanePictures& update(const app::Session& session, app::FrameCache& cache, TargetLooks& looks,
                             const PaneContent& pane);
  const PanePictures& pictures() const { return pictures_; }
  bool waiting() const { return waiting_; }

 private:
  bool show_unposed(const app::Session& session, app::FrameCache& cache, TargetLooks& looks,
                    const PaneContent& pane);
  void forget_others(const app::Session& session, const PaneContent& pane);

  PanePictures pictures_;
  std::deque<int> asked_;  // frames, the newest first
  std::vector<std::shared_ptr<const Target>> targets_;
  std::string source_;
  bool waiting_ = false;
};

/// A picture that is drawn into and shown by ImGui.
class PaneCanvas {
 public:
  /// Whether it already shows this in at least this quality.
  bool shows(const render::Scene& scene, const render::Camera& camera, render::PixelSize size) const;
  /// `fine`: in the quality of the settings; else a quick draft while things move.
  void draw(render::Renderer& renderer, const render::Scene& scene, const render::Camera& camera,
            render::PixelSize size, bool fine);
  /// Whether what it shows, old or new, is seen from there.
  bool seen_from(const render::Camera& camera, render::PixelSize size) const;
  bool fine() const { return fine_; }
  /// Its name for ImGui::Image; upside down, as OpenGL has it.
  unsigned texture() const { return texture_.name(); }
  void forget() { drawn_ = false; }

 private:
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
  SceneMemory memory;
  PaneScene made;
  EditPreview preview;
  PaneCanvas canvas;
  FlatCanvas flat;
  bool is_flat = false;      ///< the last frame was of `flat`
  std::optional<Rect> cube;  ///< of the view cube
  int cube_face = -1;        ///< under the pointer
  bool cube_held = false;
};

/// Where a ray meets the mesh of a pane's first take, as its pictures show it.
std::optional<render::SurfaceHit> take_under(const app::Session& session, const PaneContent& pane,
                                             const PanePictures& pictures, const render::Ray& ray);
/// Where a ray meets the found surface as it was drawn last, of a cloud its point; none where it is not.
std::optional<render::SurfaceHit> found_under(const app::Session& session, const BonesMemory& drawn,
                                              const render::Ray& ray);
/// The figure under the pointer where a surface shows figures: "12.4 mm", "left knee 0.83"; else empty.
std::string value_under(const app::Session& session, const Pane& pane, const ImVec2& at);
/// Whose point of a scan with several people is under the pointer; 0: nobody's.
int person_under(const app::Session& session, const Pane& pane, const ImVec2& at);
/// The found bone under the pointer; -1: none.
int bone_under(const app::Session& session, const Pane& pane, const ImVec2& at);
/// The motion that is offered whose ghost is under the pointer, in front of any other; none: there is none.
std::optional<uint64_t> offered_under(const app::Session& session, const Pane& pane, const ImVec2& at);
/// The place on a pane's surface under the pointer.
std::optional<Vec3> surface_place(const app::Session& session, const Pane& pane, const ImVec2& at);

}  // namespace understudy::ui
