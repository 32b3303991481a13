// A 2D pose as numbers for the network that lifts it into space, with what the frames before tell.
#pragma once

#include <optional>

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Of each point x, y, whether it is seen, its confidence, and its way since the frame before (x, y). Of each
/// bone of kFlatBones how long it looks of how long it is, how far its ends are apart in depth therefore, and
/// its length. Of the whole how large it is against usually and against its longest bones, its own way (x,
/// y), the interval, and whether the middle of the hips is seen.
constexpr int kLiftPointInputs = 6, kLiftBoneInputs = 3, kLiftWholeInputs = 6,
              kLiftBonesAt = kLiftPointInputs * kBodyPoints,
              kLiftWholeAt = kLiftBonesAt + kLiftBoneInputs * kFlatBoneCount,
              kLiftInputs = kLiftWholeAt + kLiftWholeInputs;
/// Of a number for a place in the picture, what a length of `size` is.
constexpr float kLiftPlaceScale = 2;

struct LiftFrame {
  Eigen::Matrix<float, 1, kLiftInputs> numbers;  ///< y up, around `origin`, of `size`
  Vec2 origin = Vec2::Zero();  ///< the middle of the hips, seen or guessed, else that of the box; pixels
  float size = 1;              ///< of the person in the last seconds (size_of), pixels
  bool has_hips = false;       ///< the origin is the middle of the hips
  bool sees_hips = false;      ///< that is not guessed
};

/// The pose with its middles. Throws Error when fewer than three of the first 15 points are seen, or one is
/// not finite.
FlatPose liftable(const FlatPose& seen);

/// Online: no answer depends on a later frame. Hips that are not seen are guessed: as far from the neck as
/// they were last, before that as in who stands upright.
class LiftInput {
 public:
  void reset() { *this = LiftInput(); }
  /// lengths: of the person, above 0; only what they are of each other counts. dt: seconds since the frame
  /// before. Throws Error where liftable() does, and when all points are in one place.
  LiftFrame push(const FlatPose& pose, const BoneLengths& lengths, float dt);

 private:
  void guess_hips(FlatPose& pose);
  void update_size(const FlatPose& pose, float dt);
  void put_points(const FlatPose& pose, bool has_way, float a_frame, LiftFrame& frame) const;
  void put_bones(const FlatPose& pose, const BoneLengths& lengths, float dt, LiftFrame& frame);

  FlatPose last_;
  std::optional<Vec2> trunk_;  // from the neck to the hips when both were seen, pixels
  Vec2 last_origin_ = Vec2::Zero();
  float size_ = 0, now_ = 0;  // in the last seconds, and in this frame; pixels
  float stature_ = 0;         // that the longest looking bones had in the last seconds, pixels
  bool has_last_ = false, had_hips_ = false;
};

}  // namespace understudy
