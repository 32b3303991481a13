#include "ui/viewport/panes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/session/follow.hpp"
#include "render/picking.hpp"
#include "retarget/base/index.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using app::Layout;
using app::Session;

constexpr float kNotch = 0.88f;  // of the distance, a notch of the wheel

PaneContent overlay(const Session& session) {
  PaneContent pane = pane_of(0);
  const int takes = session.takes.size();
  if (takes > 0) pane.takes.push_back(std::clamp(session.selected_take, 0, takes - 1));
  for (int k = 0; k < takes; ++k)
    if (k != pane.takes.front()) pane.takes.push_back(k);
  return pane;
}

std::string method_words(const app::Method& method) {
  const int engine = index_of(engines(), method.engine), extractor = index_of(extractors(), method.extractor);
  std::string words = engine < 0 ? method.engine : engines()[engine].caption;
  if (extractor > 0) words += std::string(", ") + extractors()[extractor].caption;
  if (!method.offsets) words += ", no offsets";
  return words;
}

/// As app::rest_offset; the joints are not known yet.
Vec3 offset_as_loaded(const Session& session, const PaneContent& pane) {
  const Points& vertices = shown_target(*first_take(session, pane))->mesh.vertices;
  if (vertices.rows() == 0) return Vec3::Zero();
  const Vec3 low = vertices.colwise().minCoeff().transpose(),
             high = vertices.colwise().maxCoeff().transpose();
  Vec3 offset(0.5f * (low.x() + high.x()), low.y(), 0.5f * (low.z() + high.z()));
  const Joints* now = app::pane_joints(session, pane.number, pane_frame(session, pane));
  if (!session.view.follow && now != nullptr) offset -= Vec3((*now)(Pelvis, 0), 0, (*now)(Pelvis, 2));
  return offset;
}

/// Which of View::cameras a pane looks through.
int camera_index(const Session& session, const PaneContent& pane) {
  return session.view.linked ? 0 : pane.number;
}

/// Where a ray meets the plane through the target that faces the camera.
Vec3 on_target_plane(const render::Camera& camera, const render::Ray& ray) {
  const Vec3 back = render::axes(camera).col(2);
  const float along = (camera.target - ray.origin).dot(back) / ray.direction.dot(back);
  return ray.origin + along * ray.direction;
}

/// What is under the pointer at the target's distance stays there.
render::Camera wheel_zoom(const PaneView& view, const ImVec2& at, float notches) {
  const render::Camera camera = render::zoomed(view.camera, std::pow(kNotch, notches));
  const float factor = camera.distance / view.camera.distance;
  const Vec3 under = on_target_plane(view.camera, view.ray(at));
  render::Camera moved = camera;
  moved.target = under + factor * (view.camera.target - under);
  return moved;
}

}  // namespace

std::vector<PaneContent> panes_of(const Session& session) {
  const int takes = session.takes.size();
  switch (session.view.layout) {
    case Layout::Single:
      return {pane_of(std::clamp(session.view.active_pane, 0, takes))};
    case Layout::Overlay:
      if (app::is_canvas(session, 0) || app::is_flat_take(session, session.selected_take))
        return {pane_of(std::clamp(session.view.active_pane, 0, takes))};
      return {overlay(session)};
    case Layout::Wipe:
      if (takes == 0) return {pane_of(0)};
      if (takes == 1) return {pane_of(0), pane_of(1)};
      return {pane_of(1), pane_of(2)};
    case Layout::SideBySide:
      break;
  }
  std::vector<PaneContent> panes;
  for (int number = 0; number <= takes; ++number) panes.push_back(pane_of(number));
  return panes;
}

PaneContent pane_of(int number) {
  PaneContent pane;
  pane.number = number;
  pane.source = number == 0;
  if (number > 0) pane.takes = {number - 1};
  return pane;
}

std::string pane_title(const Session& session, const PaneContent& pane) {
  std::string title = pane.source ? session.source.name : "";
  for (const int k : pane.takes) {
    const app::Take* take = at_or_null(session.document.takes, k);
    if (take == nullptr) continue;
    title += (title.empty() ? "" : "  +  ") + take->name;
  }
  return title;
}

std::string pane_method(const Session& session, const PaneContent& pane) {
  const app::Take* take =
      pane.takes.size() == 1 && !pane.source ? at_or_null(session.document.takes, pane.takes[0]) : nullptr;
  return take == nullptr || take->flat ? "" : method_words(take->method);
}

namespace {

/// In one word, of a frame that was not captured.
const char* how_made(const Session& session, const app::TakeState& state, int take, int frame) {
  const PoseEdits& edits = session.document.takes[take].pose_edits;
  if (edits.go_on && frame >= ssize(state.performed)) return "predicted";
  const auto is_in = [frame](const FillEdit& fill) { return fill.first <= frame && frame <= fill.last; };
  if (std::any_of(edits.fill.begin(), edits.fill.end(), is_in)) return "filled";
  return session.document.source.blend ? "blended" : session.document.source.complete > 0 ? "made" : "filled";
}

}  // namespace

std::string pane_made(const Session& session, const PaneContent& pane, int frame) {
  const app::TakeState* const take = pane.source ? nullptr : first_take(session, pane);
  const float* const doubt_m = take == nullptr ? nullptr : at_or_null(take->shown.doubt_m, frame);
  if (doubt_m == nullptr || *doubt_m <= 0) return "";
  return std::string(how_made(session, *take, pane.takes[0], frame)) + ", " + doubt_text(*doubt_m);
}

std::string pane_hint(const Session& session, const PaneContent& pane) {
  if (pane.source && session.document.source.path.empty())
    return "Drop a scan folder, a motion or 2D poses here";
  if (!pane.source && first_take(session, pane) == nullptr) return "Drop a character here";
  if (const app::TakeState* take = pane.source ? nullptr : first_take(session, pane)) {
    if (!take->problem.empty()) return take->problem;
    if (app::is_flat_take(session, pane.takes[0])) return take->flat ? "" : "Reading the person\u2026";
    if (shows_as_loaded(session, pane)) return "";
    if (!take->ready) return "Preparing the target\u2026";
    if (shows_rest(session, pane)) return "";
  }
  if (!session.source.problem.empty()) return session.source.problem;
  if (pane_frame(session, pane) < 0) return "Reading the first frame\u2026";
  return "";
}

const app::TakeState* first_take(const Session& session, const PaneContent& pane) {
  return pane.takes.empty() ? nullptr : at_or_null(session.takes, pane.takes[0]);
}

int frame_count(const Session& session, const PaneContent& pane) {
  if (pane.source) return session.source.frames.size();
  const app::TakeState* take = first_take(session, pane);
  if (take != nullptr && take->flat) return static_cast<int>(take->flat->poses.size());
  return take != nullptr ? ssize(take->joints) : 0;
}

int pane_frame(const Session& session, const PaneContent& pane) {
  const int count = frame_count(session, pane);
  const int shown = shown_frame(session);
  if (shown < 0 && count > 0) return shown_frame(session.playback, count);  // the selected take has none yet
  return std::min(shown, count - 1);
}

bool shows_rest(const Session& session, const PaneContent& pane) {
  const app::TakeState* take = first_take(session, pane);
  if (take == nullptr || take->target == nullptr) return false;
  const bool edited = is_of_rest(session.tool) && pane.takes[0] == session.selected_take;
  return edited || (take->joints.empty() && !pane.source);
}

Pose rest_pose(const Session& session, int take) {
  Pose pose;
  pose.root = session.takes[take].target->joints.row(Pelvis).transpose();
  if (session.tool == app::Tool::RestPose)
    pose.local = rest_rotations(session.document.takes[take].target_edits.rest_pose);
  return pose;
}

Joints rest_joints(const Session& session, int take) {
  const Joints& joints = session.takes[take].target->joints;
  if (session.tool != app::Tool::RestPose) return joints;
  return forward_kinematics(joints, rest_pose(session, take)).joints;
}

bool shows_as_loaded(const Session& session, const PaneContent& pane) {
  const app::TakeState* take = first_take(session, pane);
  return take != nullptr && !pane.source && take->target == nullptr && take->as_loaded != nullptr &&
         take->problem.empty();
}

std::shared_ptr<const Target> shown_target(const app::TakeState& take) {
  return take.target != nullptr ? take.target : take.as_loaded;
}

Vec3 follow_offset(const Session& session, const PaneContent& pane) {
  if (shows_as_loaded(session, pane)) return offset_as_loaded(session, pane);
  if (shows_rest(session, pane))
    return app::rest_offset(session, pane.takes[0] + 1, pane_frame(session, pane));
  return app::follow_offset(session, pane.number, pane_frame(session, pane));
}

render::Camera pane_camera(const Session& session, const PaneContent& pane) {
  const app::CameraState s = app::camera_of(session.view, pane.number);
  return {s.target + follow_offset(session, pane), s.yaw, s.pitch, s.distance, s.fov, s.orthographic};
}

Vec3 aside(const Session& session, const PaneContent& pane, int person) {
  const bool overlaid = pane.source && !pane.takes.empty() && !shows_rest(session, pane);
  return overlaid ? app::spread_offset(session, person) : Vec3(Vec3::Zero());
}

bool tool_on_found_bones(const Session& session, const PaneContent& pane) {
  const bool can =
      session.tool == app::Tool::Paint || (session.tool == app::Tool::Bones && session.view.source.bones);
  return can && pane.source && session.bones.rig && (pane.takes.empty() || session.bones.selected >= 0);
}

bool paints_found_bones(const Session& session, const PaneContent& pane) {
  return session.tool == app::Tool::Paint && session.bones.selected >= 0 &&
         tool_on_found_bones(session, pane);
}

int person_of_tool(const Session& session, const PaneContent& pane) {
  const bool of_source = session.tool == app::Tool::Look || session.tool == app::Tool::Joints ||
                         session.tool == app::Tool::Crop || tool_on_found_bones(session, pane);
  return of_source || pane.takes.empty() ? pane.number : pane.takes[0] + 1;
}

std::vector<std::string> camera_arguments(const Session& session, const PaneContent& pane,
                                          const render::Camera& camera) {
  const Vec3 target = camera.target - follow_offset(session, pane);
  std::vector<std::string> words{std::to_string(camera_index(session, pane))};
  for (const float x : {target.x(), target.y(), target.z(), camera.yaw, camera.pitch, camera.distance})
    words.push_back(argument(static_cast<double>(x)));
  return words;
}

render::Ray PaneView::ray(const ImVec2& at) const {
  return render::ray_through(camera, size(), Eigen::Vector2f(at.x - rect.min.x, at.y - rect.min.y));
}

std::optional<ImVec2> PaneView::project(const Vec3& point) const {
  const Vec3 seen = render::on_screen(camera, size(), point);
  if (!camera.orthographic && !(seen.z() > 0)) return std::nullopt;
  return ImVec2(rect.min.x + seen.x(), rect.min.y + seen.y());
}

PaneView PaneView::shifted(const Vec3& offset) const {
  PaneView view = *this;
  view.camera.target -= offset;
  return view;
}

int point_at(const PaneView& view, const Points& points, const ImVec2& at, float reach) {
  const Eigen::Vector2f pixel(at.x - view.rect.min.x, at.y - view.rect.min.y);
  return render::point_under(points, view.camera, view.size(), pixel, reach).value_or(-1);
}

Pointer pointer_of_item() {
  const ImGuiIO& io = ImGui::GetIO();
  Pointer pointer;
  pointer.at = io.MousePos, pointer.moved = io.MouseDelta;
  pointer.over = ImGui::IsItemHovered();
  const bool active = ImGui::IsItemActive();
  pointer.wheel = pointer.over ? io.MouseWheel : 0;
  pointer.pressed = ImGui::IsItemActivated() && ImGui::IsMouseClicked(0);
  pointer.held = active && ImGui::IsMouseDown(0);
  pointer.released = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(0);
  pointer.doubled = pointer.over && ImGui::IsMouseDoubleClicked(0);
  const bool dragged =
      active && !ImGui::IsItemActivated();  // the way to where it was pressed is no part of it
  const bool right = dragged && ImGui::IsMouseDown(1);
  pointer.turning = right && !io.KeyCtrl, pointer.lighting = right && io.KeyCtrl;
  const bool still = io.MouseDragMaxDistanceSqr[1] < io.MouseDragThreshold * io.MouseDragThreshold;
  pointer.asks = pointer.over && ImGui::IsMouseReleased(1) && still;
  pointer.panning = dragged && (ImGui::IsMouseDown(2) || (ImGui::IsMouseDown(0) && io.KeyShift));
  return pointer;
}

std::optional<render::Camera> navigated(const PaneView& view, const Pointer& pointer, bool free_left,
                                        float turn) {
  const ImVec2& moved = pointer.moved;
  if (pointer.wheel != 0) return wheel_zoom(view, pointer.at, pointer.wheel);
  if (moved.x == 0 && moved.y == 0) return std::nullopt;
  const float height = view.rect.height();  // what is at the target's distance stays under the pointer
  if (pointer.panning) return render::panned(view.camera, {moved.x / height, -moved.y / height});
  if (pointer.turning || (pointer.held && free_left && !pointer.pressed))
    return render::orbited(view.camera, -turn * moved.x, turn * moved.y);
  return std::nullopt;
}

}  // namespace understudy::ui
