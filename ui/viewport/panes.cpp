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

int clamped_take(const Session& session, int take) {
  return std::clamp<int>(take, 0, session.takes.size() - 1);
}

PaneContent overlay(const Session& session) {
  PaneContent pane = pane_of(0);
  const int takes = session.takes.size();
  if (takes > 0) pane.takes.push_back(clamped_take(session, session.selected_take));
  for (int k = 0; k < takes; ++k)
    if (k != pane.takes.front()) pane.takes.push_back(k);
  return pane;
}

std::string method_words(const app::Method& method) {
  const int engine = index_of(engines(), method.engine), extractor = index_of(extractors(), method.extractor);
  std::string words = engine < 0 ? method.engine : engines()[static_cast<size_t>(engine)].caption;
  if (extractor > 0) words += std::string(", ") + extractors()[static_cast<size_t>(extractor)].caption;
  if (!method.offsets) words += ", no offsets";
  return words;
}

const app::TakeState* state_of_take(const Session& session, const PaneContent& pane) {
  return pane.takes.empty() ? nullptr : at_or_null(session.takes, pane.takes[0]);
}

/// The T-pose is seen where the person would be.
Vec3 rest_offset(const Session& session, const PaneContent& pane) {
  const Target& target = *shown_target(*state_of_take(session, pane));
  const Points& vertices = target.mesh.vertices;
  const float floor = vertices.rows() > 0 ? vertices.col(1).minCoeff() : 0;
  Vec3 offset(target.joints(Pelvis, 0), floor, target.joints(Pelvis, 2));
  if (shows_as_loaded(session, pane) && vertices.rows() > 0) {  // its joints are not known yet
    const Vec3 middle = 0.5f * (vertices.colwise().minCoeff() + vertices.colwise().maxCoeff()).transpose();
    offset = Vec3(middle.x(), floor, middle.z());
  }
  const PaneContent moving = pane_of(pane.number);
  const Joints* now = app::pane_joints(session, pane.number, pane_frame(session, moving));
  if (!session.view.follow && now != nullptr) offset -= Vec3((*now)(Pelvis, 0), 0, (*now)(Pelvis, 2));
  return offset;
}

}  // namespace

const app::TakeState* take_of(const Session& session, int take) {
  return at_or_null(session.takes, take);
}

int frame_count(const Session& session, const PaneContent& pane) {
  if (pane.source) return session.source.frames.size();
  const app::TakeState* take = state_of_take(session, pane);
  return take != nullptr ? ssize(take->joints) : 0;
}

std::vector<PaneContent> panes_of(const Session& session) {
  const int takes = session.takes.size();
  switch (session.view.layout) {
    case Layout::Single:
      return {pane_of(std::clamp(session.view.active_pane, 0, takes))};
    case Layout::Overlay:
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
    if (pane.takes.size() == 1 && !pane.source) title += "  \u00b7  " + method_words(take->method);
  }
  return title;
}

std::string pane_hint(const Session& session, const PaneContent& pane) {
  if (pane.source && session.document.source.path.empty()) return "Drop a scan folder or a motion here";
  if (pane.empty() || (!pane.source && state_of_take(session, pane) == nullptr))
    return "Drop a character here";
  if (const app::TakeState* take = pane.source ? nullptr : state_of_take(session, pane)) {
    if (!take->problem.empty()) return take->problem;
    if (shows_as_loaded(session, pane)) return "";
    if (!take->ready) return "Preparing the target\u2026";
    if (shows_rest(session, pane)) return "";
  }
  if (pane_frame(session, pane) < 0) return "Reading the first frame\u2026";
  return "";
}

int pane_frame(const Session& session, const PaneContent& pane) {
  const int count = frame_count(session, pane);
  const int shown = shown_frame(session);
  if (shown < 0 && count > 0) return shown_frame(session.playback, count);  // the selected take has none yet
  return std::min(shown, count - 1);
}

bool shows_rest(const Session& session, const PaneContent& pane) {
  const app::TakeState* take = state_of_take(session, pane);
  if (take == nullptr || take->target == nullptr) return false;
  const bool edited = session.tool == app::Tool::TargetJoints && pane.takes[0] == session.selected_take;
  return edited || (take->joints.empty() && !pane.source);
}

bool shows_as_loaded(const Session& session, const PaneContent& pane) {
  const app::TakeState* take = state_of_take(session, pane);
  return take != nullptr && !pane.source && take->target == nullptr && take->as_loaded != nullptr &&
         take->problem.empty();
}

std::shared_ptr<const Target> shown_target(const app::TakeState& take) {
  return take.target != nullptr ? take.target : take.as_loaded;
}

const Joints* pane_joints(const Session& session, const PaneContent& pane, int frame) {
  return app::pane_joints(session, pane.source || pane.takes.empty() ? 0 : pane.takes[0] + 1, frame);
}

render::Camera camera_of(const app::CameraState& state) {
  render::Camera camera;
  camera.target = state.target;
  camera.yaw = state.yaw, camera.pitch = state.pitch;
  camera.distance = state.distance, camera.fov = state.fov;
  camera.orthographic = state.orthographic;
  return camera;
}

app::CameraState state_of(const render::Camera& camera) {
  app::CameraState state;
  state.target = camera.target;
  state.yaw = camera.yaw, state.pitch = camera.pitch;
  state.distance = camera.distance, state.fov = camera.fov;
  state.orthographic = camera.orthographic;
  return state;
}

int camera_index(const app::View& view, const PaneContent& pane) {
  return view.linked ? 0 : pane.number;
}

app::CameraState camera_state(const app::View& view, const PaneContent& pane) {
  const size_t index = camera_index(view, pane);
  if (index < view.cameras.size()) return view.cameras[index];
  return view.cameras.empty() ? app::CameraState{} : view.cameras[0];
}

Vec3 follow_offset(const Session& session, const PaneContent& pane) {
  if (shows_rest(session, pane) || shows_as_loaded(session, pane)) return rest_offset(session, pane);
  const int person = pane.source || pane.takes.empty() ? 0 : pane.takes[0] + 1;
  return app::follow_offset(session, person, pane_frame(session, pane));
}

render::Camera pane_camera(const Session& session, const PaneContent& pane) {
  render::Camera camera = camera_of(camera_state(session.view, pane));
  camera.target += follow_offset(session, pane);
  return camera;
}

std::vector<std::string> camera_arguments(const Session& session, const PaneContent& pane,
                                          const render::Camera& camera) {
  const Vec3 target = camera.target - follow_offset(session, pane);
  std::vector<std::string> words{std::to_string(camera_index(session.view, pane))};
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

int joint_at(const PaneView& view, const Joints& joints, const ImVec2& at, float reach) {
  const Eigen::Vector2f pixel(at.x - view.rect.min.x, at.y - view.rect.min.y);
  return render::point_under(joints, view.camera, view.size(), pixel, reach).value_or(-1);
}

}  // namespace understudy::ui
