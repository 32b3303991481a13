#include "ui/viewport/face_hand.hpp"

#include <cmath>
#include <utility>

#include "retarget/editing/target_edits.hpp"
#include "retarget/pose2d/body_view.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/hand.hpp"
#include "ui/viewport/pane.hpp"

namespace understudy::ui {
namespace {

constexpr float kMarkReach = 12;  // points around a mark in which it is met
constexpr float kLeastDrag = 2;   // points: less was a click
constexpr float kOfHead = 0.5f;   // how much of a vertex follows the head that a mark may lie on

float pixels_between(const ImVec2& a, const ImVec2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// The take whose marks a pane shows; null: none.
const app::TakeState* faced_take(const app::Session& session, const PaneContent& pane) {
  const bool shows = session.tool == app::Tool::Face && !pane.source && shows_rest(session, pane) &&
                     pane.takes[0] == session.selected_take;
  const app::TakeState* const take = shows ? first_take(session, pane) : nullptr;
  return take != nullptr && take->weights ? take : nullptr;
}

/// Where the pointer meets the head; of a cloud across the view, as deep as the mark lies.
std::optional<Vec3> place_on_head(const HandPlace& place, const app::TakeState& take, const ImVec2& at,
                                  const Vec3& now) {
  const render::Ray ray = place.view.ray(at);
  if (take.target->mesh.is_cloud()) {
    const Vec3 ahead = (place.view.camera.target - render::eye(place.view.camera)).normalized();
    return ray.origin + ahead.dot(now - ray.origin) / ahead.dot(ray.direction) * ray.direction;
  }
  const auto hit = take_under(place.session, place.pane, place.pictures, ray);
  if (!hit || (*take.weights)(hit->vertex, Head) < kOfHead) return std::nullopt;
  return hit->position;
}

}  // namespace

void FaceHand::let_go() {
  grip_.reset();
  hovered_ = -1;
}

std::string FaceHand::tip() const {
  return hovered_ < 0 ? "" : face_mark_label(static_cast<FaceMark>(hovered_));
}

/// In the T-pose, with the drag.
std::array<Vec3, kFaceMarkNames.size()> FaceHand::places(const app::Session& session, int take) const {
  std::vector<FaceMove> moves = session.document.takes[static_cast<size_t>(take)].target_edits.face;
  const app::TakeState& state = session.takes[static_cast<size_t>(take)];
  const Joints& rest = state.target->joints;
  if (grip_ && grip_->is_moved) {
    put(grip_->move, moves);
    if (session.mirror_joint) put(mirrored(grip_->move, symmetry_centre(rest)), moves);
  }
  FaceMarks marks = moved_marks(state.face, rest, moves);
  std::array<Vec3, kFaceMarkNames.size()> places;
  for (size_t k = 0; k < places.size(); ++k)
    places[k] = rest.row(Head).transpose() + place_of(static_cast<FaceMark>(k), marks);
  return places;
}

std::vector<Overlay::Handle> FaceHand::handles(const app::Session& session, const PaneContent& pane,
                                               const PaneView& view) const {
  if (faced_take(session, pane) == nullptr) return {};
  const Pinhole camera = render::pinhole(view.camera, view.size());
  const auto all = places(session, pane.takes[0]);
  std::vector<Overlay::Handle> handles;
  for (size_t k = 0; k < all.size(); ++k) {
    const auto at = view.project(all[k]);
    const int point = point_of(static_cast<FaceMark>(k));
    if (!at || is_turned_away(point, all[k], Mat3::Identity(), camera)) continue;
    handles.push_back({*at, "view." + std::to_string(pane.number) + ".face." + kFaceMarkNames[k],
                       static_cast<int>(k) == hovered_});
  }
  return handles;
}

bool FaceHand::work(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue) {
  if (grip_) {
    drag(place, pointer);
    if (pointer.released || !pointer.held) finish(place, queue);
    return true;
  }
  hovered_ = -1;
  float nearest = kMarkReach * place.scale;
  ImVec2 at{0, 0};
  for (const Overlay::Handle& handle : handles(place.session, place.pane, place.view)) {
    const float distance = pixels_between(handle.at, pointer.at);
    if (distance >= nearest) continue;
    nearest = distance, at = handle.at;
    const std::string name = handle.name.substr(handle.name.rfind('.') + 1);
    for (size_t k = 0; k < kFaceMarkNames.size(); ++k)
      if (name == kFaceMarkNames[k]) hovered_ = static_cast<int>(k);
  }
  if (hovered_ < 0) return false;
  if (pointer.pressed)
    grip_ = Grip{{static_cast<FaceMark>(hovered_),
                  places(place.session, place.pane.takes[0])[static_cast<size_t>(hovered_)]},
                 pointer.at,
                 {at.x - pointer.at.x, at.y - pointer.at.y}};
  return true;
}

/// Beside the head it stays where it was last.
void FaceHand::drag(const HandPlace& place, const Pointer& pointer) {
  if (!grip_->is_moved && pixels_between(pointer.at, grip_->start) < kLeastDrag * place.scale) return;
  const app::TakeState* const take = faced_take(place.session, place.pane);
  if (take == nullptr) return;
  const ImVec2 at(pointer.at.x + grip_->off.x, pointer.at.y + grip_->off.y);
  const auto to = place_on_head(place, *take, at, grip_->move.place);
  if (!to) return;
  grip_->move.place = *to;
  grip_->is_moved = true;
}

void FaceHand::finish(const HandPlace& place, app::CommandQueue& queue) {
  const Grip grip = *std::exchange(grip_, std::nullopt);
  if (!grip.is_moved || place.pane.takes.empty()) return;
  app::Arguments words{std::to_string(place.pane.takes[0]),
                       kFaceMarkNames[static_cast<size_t>(grip.move.mark)]};
  for (int k = 0; k < 3; ++k) words.push_back(argument(static_cast<double>(grip.move.place[k])));
  if (place.session.mirror_joint) words.push_back("mirror");
  queue.push_back({"edit.face_mark", words});
}

}  // namespace understudy::ui
