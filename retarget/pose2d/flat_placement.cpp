#include "retarget/pose2d/flat_placement.hpp"

#include <algorithm>

#include "retarget/keypoints/change_points.hpp"

namespace understudy {
namespace {

constexpr std::array<int, 8> kFeet = {body25::RightAnkle,    body25::LeftAnkle,   body25::RightHeel,
                                      body25::LeftHeel,      body25::RightBigToe, body25::LeftBigToe,
                                      body25::RightSmallToe, body25::LeftSmallToe};

constexpr std::array<int, 2> kMiddles = {body25::MidHip, body25::Neck};

/// How far down the picture the feet reach: of the points that both poses have.
std::optional<float> lowest_of(const FlatPose& pose, const FlatPose& also) {
  std::optional<float> lowest;
  for (const int point : kFeet)
    if (pose.has(point) && also.has(point))
      lowest = std::max(lowest.value_or(pose.at(point).y()), pose.at(point).y());
  return lowest;
}

Vec2 middle_of_box(const FlatPose& pose) {
  const FlatBox box = box_of(pose);
  return box.isEmpty() ? Vec2(Vec2::Zero()) : Vec2(box.center());
}

}  // namespace

void forget_feet(FlatPose& pose) {
  for (const int point : kFeet) pose.forget(point);
}

void move_pose(const Vec2& way, FlatPose& pose) {
  change_points(pose, [&](const Vec2& place) -> Vec2 { return place + way; });
}

void scale_pose(float times, FlatPose& pose) {
  Vec2 middle = middle_of_box(pose);
  for (size_t k = kMiddles.size(); k-- > 0;)
    if (pose.has(kMiddles[k])) middle = pose.at(kMiddles[k]);
  change_points(pose, [&](const Vec2& place) -> Vec2 { return middle + times * (place - middle); });
}

FlatPlacement::FlatPlacement(const std::optional<FlatPose>& standing, float target_leg)
    : standing_(standing), leg_(target_leg) {}

/// Where the first pose goes: onto a middle that the target's picture shows, too, else box onto box.
void FlatPlacement::start(const FlatPose& source, const FlatPose& pose) {
  started_ = true;
  way_ = Vec2::Zero();
  if (!standing_) {
    for (size_t k = kMiddles.size(); k-- > 0;)
      if (source.has(kMiddles[k]) && pose.has(kMiddles[k]))
        way_ = source.at(kMiddles[k]) - pose.at(kMiddles[k]);
    return;
  }
  way_ = middle_of_box(*standing_) - middle_of_box(pose);
  for (size_t k = kMiddles.size(); k-- > 0;)
    if (standing_->has(kMiddles[k]) && pose.has(kMiddles[k]))
      way_ = standing_->at(kMiddles[k]) - pose.at(kMiddles[k]);
}

/// By the mid-hip, without one by the neck, which goes on from where it was when both were last seen.
Vec2 FlatPlacement::way_of(const FlatPose& source, float ratio, const FlatPose& pose) {
  const auto is_seen = [&](size_t k) { return source.has(kMiddles[k]) && pose.has(kMiddles[k]); };
  for (size_t k = kMiddles.size(); k-- > 0;)
    if (anchors_[k] && is_seen(k))
      way_ = anchors_[k]->to + ratio * (source.at(kMiddles[k]) - anchors_[k]->from) - pose.at(kMiddles[k]);
  for (size_t k = 0; k < kMiddles.size(); ++k)
    if (is_seen(k) && (k > 0 || !anchors_[k]))
      anchors_[k] = Anchor{source.at(kMiddles[k]), pose.at(kMiddles[k]) + way_};
  return way_;
}

void FlatPlacement::push(const FlatPose& source, float source_leg, FlatPose& pose) {
  if (is_nobody(source)) return;
  const float ratio = leg_ / std::max(source_leg, 1e-6f);
  const bool is_first = !started_;
  if (is_first) start(source, pose);
  Vec2 way = way_of(source, ratio, pose);
  // Up and down as the feet go, where they are seen.
  const auto low = lowest_of(source, pose), made = lowest_of(pose, source);
  if (low && made) {
    if (!feet_) {
      // Feet that come into the picture later find everybody where they are.
      feet_ = Line{*low, standing_ || !is_first ? *made + way.y() : *low};
      // Some pictures show heels and toes, others ankles alone.
      if (standing_ && is_first)
        if (const auto stands = lowest_of(*standing_, pose))
          feet_->to = *made + *stands - *lowest_of(pose, *standing_);
    }
    lift_ = feet_->to + ratio * (*low - feet_->from) - *made - way.y();
  }
  way.y() += lift_;
  move_pose(way, pose);
}

}  // namespace understudy
