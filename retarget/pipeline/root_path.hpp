// Where the target's pelvis goes: the source's path scaled by leg length, soles on the floor as the source's
// are.
#pragma once

#include <optional>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/running_median.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

enum class RootMode { Scaled, Original, InPlace };
constexpr Names<3> kRootNames{"scaled", "original", "in-place"};

struct RootPathOptions {
  RootMode mode = RootMode::Scaled;  ///< the path over the floor; heights are scaled in every mode
  /// 0..1: how much of a sole's way into the floor, or above it in contact, is taken out
  float contact = 0.5f;
  float contact_height_m = 0.04f;  ///< a source's foot this low is in contact
  float settle_s = 1.0f;           ///< time in which the height's offset follows its estimate
  float stride = 1;        ///< steps, and a scaled path, against what the leg lengths give; see step()
  float hip_height_m = 0;  ///< the pelvis stands so much higher than the leg lengths give; see step()
};

/// Lowest points of a body in T-pose, each moved rigidly with one joint: what may touch the floor.
struct SupportPoints {
  std::vector<int> joint;
  Points offset;  ///< [N, 3] from the joint, T-pose axes, metres
  /// Points of `rest` under the feet, and one under each knee, wrist and the pelvis for the falls. Joints
  /// must be the T-pose's. With no vertices the joints themselves.
  static SupportPoints from(const Points& rest, const Joints& rest_joints);
  /// Height of the lowest point above the pelvis (negative).
  float lowest(const PosedSkeleton& posed) const;
  /// World height of the lowest point of one foot, 0 left, 1 right.
  float lowest_of_foot(const PosedSkeleton& posed, int side) const;
};

/// Height over y = 0 of the soles: the lowest scan points near the foot joints that lie as densely as a body
/// does (bits of floor and outliers do not), metres. None where fewer than 20 points are near. Feet that are
/// lost (is_lost) have no soles.
std::optional<float> sole_height(const Extraction& source, const Points& scan);

/// Online: only the frames so far. s = leg_B / leg_A, leg_A the median over the frames so far; the path is
/// summed from scaled steps, so that a better s never makes it jump.
class RootPath {
 public:
  explicit RootPath(const RootPathOptions& options = {}) : options_(options) {}
  void reset(const Points& rest_b, const Joints& joints_b);
  /// The target's pelvis in the world, metres. source: the source's joints and, where seen, the height of its
  /// soles; local_b: the target's local rotations; dt seconds since the last frame.
  Vec3 push(const Extraction& source, const Rotations& local_b, float dt);
  /// The pose with its steps and its pelvis' height as the options want them. With h the hip and a the ankle
  /// of a leg over the floor, and p the path of push(): a' = h + stride (a - h), as p' = stride p, so a foot
  /// that stands still stands still. Feet keep their heights and rotations; the pelvis rises by hip_height_m,
  /// but no further than the legs of standing feet reach, and comes down where steps are too long for them.
  Pose step(const Pose& pose) const;
  /// The pose of the last push() with its legs bent or stretched so that soles in contact are as high as the
  /// source's: what the pelvis' height could not make good without shaking the body. Where a leg is too short
  /// the body comes down.
  Pose plant(const Pose& pose, float dt);
  float scale() const { return scale_; }

 private:
  float clearance(const Extraction& source) const;
  float standing(float above) const;

  RootPathOptions options_;
  Joints rest_b_ = Joints::Zero();
  SupportPoints support_;
  float leg_b_ = 1;
  RunningMedian leg_a_, offsets_;
  Vec3 last_source_ = Vec3::Zero(), root_ = Vec3::Zero();
  float offset_ = 0, correction_ = 0, pelvis_error_ = 0, scale_ = 1;
  float sole_ = 0;       // height that the lowest sole should have
  float touching_ = 0;   // 0..1, how far the source is in contact
  float left_over_ = 0;  // metres that legs are to make good
  float lowered_ = 0;    // metres that the body came down because its legs were too short
  bool started_ = false;
};

}  // namespace understudy
