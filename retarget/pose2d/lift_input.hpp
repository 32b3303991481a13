// A 2D pose as numbers for the network that lifts it into space, with what the frames before tell.
#pragma once

#include <optional>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Of each point x, y, whether it is seen, its confidence, and its way since the frame before (x, y); then of
/// the whole: how large it is against usually, its own way (x, y), the interval, and whether the middle of
/// the hips is seen.
constexpr int kLiftPointInputs = 6, kLiftInputs = kLiftPointInputs * kBodyPoints + 5;
/// Of a number for a place in the picture, what a length of `size` is.
constexpr float kLiftPlaceScale = 2;

struct LiftFrame {
  Eigen::Matrix<float, 1, kLiftInputs> numbers;  ///< y up, around `origin`, of `size`
  Vec2 origin = Vec2::Zero();  ///< the middle of the hips, seen or guessed, else that of the box; pixels
  float size = 1;              ///< of the person in the last seconds (size_of), pixels
  bool has_hips = false;       ///< the origin is the middle of the hips
  bool sees_hips = false;      ///< that is not guessed
};

/// Online: no answer depends on a later frame. Hips that are not seen are guessed: as far from the neck as
/// they were last, before that as in who stands upright.
class LiftInput {
 public:
  void reset() { *this = LiftInput(); }
  /// dt: seconds since the frame before. Throws Error when fewer than three of the first 15 points are seen,
  /// all in one place, or one is not finite.
  LiftFrame push(const FlatPose& pose, float dt);

 private:
  void guess_hips(FlatPose& pose);

  FlatPose last_;
  std::optional<Vec2> trunk_;  // from the neck to the hips when both were seen, pixels
  Vec2 last_origin_ = Vec2::Zero();
  float size_ = 0;
  bool has_last_ = false, had_hips_ = false;
};

}  // namespace understudy
