#include "retarget/pose2d/flat_placement.hpp"

#include <algorithm>

namespace understudy {
namespace {

constexpr std::array<int, 8> kFeet = {body25::RightAnkle,    body25::LeftAnkle,   body25::RightHeel,
                                      body25::LeftHeel,      body25::RightBigToe, body25::LeftBigToe,
                                      body25::RightSmallToe, body25::LeftSmallToe};

/// The middle of the body: the mid-hip, without one the neck, or whatever is seen.
Vec2 middle_of_body(const FlatPose& pose) {
  for (const int point : {static_cast<int>(body25::MidHip), static_cast<int>(body25::Neck)})
    if (pose.has(point)) return pose.at(point);
  const FlatBox box = box_of(pose);
  return box.isEmpty() ? Vec2(Vec2::Zero()) : Vec2(box.center());
}

/// How far down the picture the feet reach: of the points that both poses have.
std::optional<float> lowest_of(const FlatPose& pose, const FlatPose& also) {
  std::optional<float> lowest;
  for (const int point : kFeet)
    if (pose.has(point) && also.has(point))
      lowest = std::max(lowest.value_or(pose.at(point).y()), pose.at(point).y());
  return lowest;
}

void move_points(const Vec2& way, FlatPoints& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 2) > 0) points.row(i).head<2>() += way.transpose();
}

}  // namespace

void move_pose(const Vec2& way, FlatPose& pose) {
  for (int point = 0; point < kBodyPoints; ++point)
    if (pose.has(point)) pose.set(point, pose.at(point) + way, pose.confidence(point));
  for (FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face}) move_points(way, *points);
}

FlatPlacement::FlatPlacement(const std::optional<FlatPose>& standing, float target_leg)
    : standing_(standing), leg_(target_leg) {}

void FlatPlacement::push(const FlatPose& source, float source_leg, FlatPose& pose) {
  if (is_nobody(source)) return;
  const float ratio = leg_ / std::max(source_leg, 1e-6f);
  const Vec2 middle = middle_of_body(source);
  if (!started_) {
    from_ = middle;
    to_ = standing_ ? middle_of_body(*standing_) : middle;
    started_ = true;
  }
  Vec2 way = to_ + ratio * (middle - from_) - middle_of_body(pose);
  // Up and down as the feet go, where they are seen.
  const auto low = lowest_of(source, pose), made = lowest_of(pose, source);
  if (low && made) {
    if (!feet_) {
      feet_ = Line{*low, standing_ ? *made + way.y() : *low};
      // Some pictures show heels and toes, others ankles alone.
      if (standing_)
        if (const auto stands = lowest_of(*standing_, pose))
          feet_->to = *made + *stands - *lowest_of(pose, *standing_);
    }
    lift_ = feet_->to + ratio * (*low - feet_->from) - *made - way.y();
  }
  way.y() += lift_;
  move_pose(way, pose);
}

}  // namespace understudy
