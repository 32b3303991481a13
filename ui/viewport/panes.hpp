// The panes of the views: what each one shows, and from which camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.hpp"
#include "render/camera.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// The content of one picture. Numbers as in View::active_pane: 0 the source, k the take k - 1.
struct PaneContent {
  bool source = false;
  std::vector<int> takes;  ///< indices of takes, the first is the one that tools and hovering are about
  int number = 0;          ///< of View::active_pane after a click on it
  bool empty() const { return !source && takes.empty(); }
  bool operator==(const PaneContent& o) const {
    return source == o.source && takes == o.takes && number == o.number;
  }
};

/// Pane by pane, left to right, as the layout says. A wipe has two, drawn over each other: what is left of
/// its line and what is right of it (source and take where there is only one take).
std::vector<PaneContent> panes_of(const app::Session& session);
/// One pane that shows the source or one take.
PaneContent pane_of(int number);

/// "dance", or "adult, paper" with the method where two takes are of one target.
std::string pane_title(const app::Session& session, const PaneContent& pane);
/// Why the pane is empty, for the user; empty when it is not.
std::string pane_hint(const app::Session& session, const PaneContent& pane);

/// A take's state; null where there is no such take.
const app::TakeState* take_of(const app::Session& session, int take);
/// How many frames a pane has to show.
int frame_count(const app::Session& session, const PaneContent& pane);
/// The frame a pane shows: the current frame, or the pane's last one if that is earlier; -1 without any.
int pane_frame(const app::Session& session, const PaneContent& pane);
/// Whether a pane shows the T-pose of its take's target instead of a frame: while that is edited, and before
/// there is a frame.
bool shows_rest(const app::Session& session, const PaneContent& pane);
/// Whether a pane shows its take's character as loaded, until it is bound.
bool shows_as_loaded(const app::Session& session, const PaneContent& pane);
/// The mesh drawn for a take: its target, or before that the character as loaded; null before both.
std::shared_ptr<const Target> shown_target(const app::TakeState& take);
/// The joints of the pane's first person in a frame (extracted or performed); null where there are none.
const Joints* pane_joints(const app::Session& session, const PaneContent& pane, int frame);

render::Camera camera_of(const app::CameraState& state);
app::CameraState state_of(const render::Camera& camera);
/// Which of View::cameras a pane looks through, and that camera.
int camera_index(const app::View& view, const PaneContent& pane);
app::CameraState camera_state(const app::View& view, const PaneContent& pane);

/// What a pane's camera adds to its target: app::follow_offset() of its person, or the way to the T-pose.
Vec3 follow_offset(const app::Session& session, const PaneContent& pane);
/// The camera that a pane is drawn with.
render::Camera pane_camera(const app::Session& session, const PaneContent& pane);
/// The arguments of view.camera_state: the number of the camera, then target, yaw, pitch (radians) and
/// distance of a camera that a pane is to be drawn with.
std::vector<std::string> camera_arguments(const app::Session& session, const PaneContent& pane,
                                          const render::Camera& camera);

/// A pane's picture on the screen: where it is and what it is seen through.
struct PaneView {
  Rect rect;  ///< whole pixels
  render::Camera camera;
  render::PixelSize size() const { return {static_cast<int>(rect.width()), static_cast<int>(rect.height())}; }
  /// The ray through a pixel.
  render::Ray ray(const ImVec2& at) const;
  /// Where a point of the world is seen; none behind the eye.
  std::optional<ImVec2> project(const Vec3& point) const;
  /// Metres that a pixel covers at a point of the world.
  float metres_a_pixel(const Vec3& point) const { return render::metres_a_pixel(camera, size(), point); }
};

/// The joint seen nearest to a pixel, at most `reach` pixels away; -1 for none.
int joint_at(const PaneView& view, const Joints& joints, const ImVec2& at, float reach);

}  // namespace understudy::ui
