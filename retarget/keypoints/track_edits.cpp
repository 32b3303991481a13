#include "retarget/keypoints/track_edits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "retarget/keypoints/exchanged_sides.hpp"

namespace understudy {
namespace {

constexpr int kArms = 0, kLegs = 1;  // groups of ExchangedSides

bool is_exchanged(const SidesExchange& exchange, int point) {
  switch (exchange.limbs) {
    case SidesExchange::Limbs::Arms:
      return ExchangedSides::is_in_group(point, kArms);
    case SidesExchange::Limbs::Legs:
      return ExchangedSides::is_in_group(point, kLegs);
    case SidesExchange::Limbs::Both:
      break;
  }
  return true;
}

void exchange(const SidesExchange& edit, FlatPose& pose) {
  const FlatPose other = sides_exchanged(pose);
  for (int point = 0; point < kBodyPoints; ++point)
    if (is_exchanged(edit, point)) pose.body.row(point) = other.body.row(point);
  if (edit.limbs == SidesExchange::Limbs::Legs) return;
  pose.left_hand = other.left_hand;
  pose.right_hand = other.right_hand;
}

/// Nothing is flagged there any more: the user has looked.
void exchange(const SidesExchange& edit, std::vector<CleanPose>& clean) {
  const auto end = std::min<int64_t>(static_cast<int64_t>(clean.size()), int64_t{edit.last} + 1);
  for (int64_t t = std::max(0, edit.first); t < end; ++t) {
    CleanPose& one = clean[static_cast<size_t>(t)];
    exchange(edit, one.pose);
    if (std::exchange(one.sides_mended, false)) one.problem.clear();
  }
}

void move_points(const Vec2& way, FlatPoints& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 2) > 0) points.row(i).head<2>() += way.transpose();
}

/// With what rides along.
void move_point(int point, const Vec2& way, FlatPose& pose) {
  pose.set(point, pose.at(point) + way, 1);
  if (point == body25::LeftWrist) move_points(way, pose.left_hand);
  if (point == body25::RightWrist) move_points(way, pose.right_hand);
  if (point != body25::Nose) return;
  move_points(way, pose.face);
  for (const int part : {body25::LeftEye, body25::RightEye, body25::LeftEar, body25::RightEar})
    if (pose.has(part)) pose.set(part, pose.at(part) + way, pose.confidence(part));
}

void drag(const PointDrag& edit, std::vector<CleanPose>& clean) {
  const int count = static_cast<int>(clean.size());
  if (edit.frame >= count || is_nobody(clean[static_cast<size_t>(edit.frame)].pose)) return;
  const Vec2 place(edit.x, edit.y);
  FlatPose& here = clean[static_cast<size_t>(edit.frame)].pose;
  if (!here.has(edit.point)) return here.set(edit.point, place, 1);
  const Vec2 way = place - here.at(edit.point);
  const int first = std::max(0, edit.frame - edit.falloff),
            last = static_cast<int>(std::min<int64_t>(count - 1, int64_t{edit.frame} + edit.falloff));
  for (int t = first; t <= last; ++t) {
    FlatPose& pose = clean[static_cast<size_t>(t)].pose;
    const float apart = static_cast<float>(std::abs(t - edit.frame)) / static_cast<float>(edit.falloff + 1);
    if (pose.has(edit.point)) move_point(edit.point, 0.5f * (1 + std::cos(kPi * apart)) * way, pose);
  }
}

}  // namespace

void add_drag(const PointDrag& drag, std::vector<TrackEdit>& edits) {
  if (!edits.empty())
    if (const auto* const last = std::get_if<PointDrag>(&edits.back()))
      if (last->frame == drag.frame && last->point == drag.point) edits.pop_back();
  edits.emplace_back(drag);
}

void edit_track(const std::vector<TrackEdit>& edits, std::vector<CleanPose>& clean) {
  for (const TrackEdit& edit : edits) {
    if (const auto* const exchanged = std::get_if<SidesExchange>(&edit)) exchange(*exchanged, clean);
    if (const auto* const dragged = std::get_if<PointDrag>(&edit)) drag(*dragged, clean);
  }
}

}  // namespace understudy
