// The panes of the views: what each one shows, from which camera, and how the mouse moves that camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.hpp"
#include "render/camera.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// The content of one picture.
struct PaneContent {
  bool source = false;
  std::vector<int> takes;  ///< indices of takes, the first is the one that tools and hovering are about
  /// As in View::active_pane: 0 the source, k the take k - 1. Whose person tools, hovering and the camera are
  /// about, as app::pane_joints() numbers people.
  int number = 0;
  bool operator==(const PaneContent& o) const {
    return source == o.source && takes == o.takes && number == o.number;
  }
};

/// Pane by pane, left to right, as the layout has them. A wipe has two, drawn over each other: what is left
/// of its line and what is right of it (source and take where there is only one take).
std::vector<PaneContent> panes_of(const app::Session& session);
/// One pane that shows the source or one take.
PaneContent pane_of(int number);

/// "dance", or "dance  +  adult" where several are in one pane.
std::string pane_title(const app::Session& session, const PaneContent& pane);
/// How the pane's only take is made, "copied rotations"; empty for others.
std::string pane_method(const app::Session& session, const PaneContent& pane);
/// "filled, ± 3 cm" where the first take's frame was made and not captured, "predicted, ± 9 cm" beyond the
/// last that was; else empty.
std::string pane_made(const app::Session& session, const PaneContent& pane, int frame);
/// Why the pane is empty, for the user; empty when it is not.
std::string pane_hint(const app::Session& session, const PaneContent& pane);

/// The state of the pane's first take; null where there is none.
const app::TakeState* first_take(const app::Session& session, const PaneContent& pane);
/// The number of frames of the pane: of the source, or of its first take.
int frame_count(const app::Session& session, const PaneContent& pane);
/// The frame a pane shows: the current frame, or the pane's last one if that is earlier; -1 without any.
int pane_frame(const app::Session& session, const PaneContent& pane);
/// Whether a pane shows the T-pose of its take's target instead of a frame: while that is edited, and before
/// there is a frame.
bool shows_rest(const app::Session& session, const PaneContent& pane);
/// How a take's target is seen there: in T-pose, or, while that is edited, in its rest pose.
/// It must be ready.
Pose rest_pose(const app::Session& session, int take);
Joints rest_joints(const app::Session& session, int take);
/// Whether a pane shows its take's character as loaded, until it is bound.
bool shows_as_loaded(const app::Session& session, const PaneContent& pane);
/// The mesh drawn for a take: its target, or before that the character as loaded; null before both.
std::shared_ptr<const Target> shown_target(const app::TakeState& take);

/// What a pane's camera adds to its target: app::follow_offset() of its person, or the offset to the T-pose.
Vec3 follow_offset(const app::Session& session, const PaneContent& pane);
/// The camera that a pane is drawn with.
render::Camera pane_camera(const app::Session& session, const PaneContent& pane);
/// How far a person stands from its place in a pane whose people stand side by side, metres; zero in others.
Vec3 aside(const app::Session& session, const PaneContent& pane, int person);
/// Whether the tool in use is about the bones that were found in the source: where they are shown in a pane
/// (or painted), and one of them is chosen where the pane shows takes, too.
bool tool_on_found_bones(const app::Session& session, const PaneContent& pane);
/// Whether the weights of one of them are painted there.
bool paints_found_bones(const app::Session& session, const PaneContent& pane);
/// Whom the tool in use and the joints' names are about, as app::pane_joints() numbers people.
int person_of_tool(const app::Session& session, const PaneContent& pane);
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
  /// The view in which what stands `offset` metres from its place is seen where it is drawn.
  PaneView shifted(const Vec3& offset) const;
};

/// The point (joint) seen nearest to a pixel, at most `reach` pixels away; -1 for none.
int point_at(const PaneView& view, const Points& points, const ImVec2& at, float reach);

/// What the mouse does in a pane in one frame.
struct Pointer {
  ImVec2 at{0, 0}, moved{0, 0};                          ///< pixels; moved since the last frame
  float wheel = 0;                                       ///< notches, > 0 away from the user
  bool over = false;                                     ///< over the pane, and nothing else has the mouse
  bool pressed = false, held = false, released = false;  ///< left button; pressed: over the pane
  bool doubled = false;                                  ///< double click of the left button
  bool turning = false, panning = false;  ///< right, or middle and shift-left, pressed over the pane
  bool lighting = false;                  ///< control-right, pressed over the pane
  bool asks = false;                      ///< a right click that dragged nothing: for what can be done there
};
/// Of the pane's item, just made.
Pointer pointer_of_item();

/// The camera after all that the pointer does in this frame; none when it stays. free_left: the tool leaves
/// the left button to the camera. turn: radians for each pixel of dragging.
std::optional<render::Camera> navigated(const PaneView& view, const Pointer& pointer, bool free_left,
                                        float turn);

}  // namespace understudy::ui
