// What the engine `hybrid` sees of a frame: the extracted joints, and what the analytic solve makes of them.
#pragma once

#include "retarget/pipeline/copy_transfer.hpp"

namespace understudy::nn {

struct HybridFrame {
  Joints joints = Joints::Zero();  ///< extracted and repaired, world, metres
  float leg = 1;                   ///< leg length, mean over the frames so far, metres
  float dt = 1.0f / 30;            ///< seconds since the frame before
  Eigen::Array<float, kJointCount, 1> confidence = Eigen::Array<float, kJointCount, 1>::Ones();
  Rotations solved = identity_rotations();  ///< world rotations of the analytic solve
  Rotations seen = identity_rotations();    ///< world rotations seen on the surface; the solve's, where none
  bool has_seen = false;
};

/// The analytic solve, frame by frame, as training and the engine both need it.
class HybridSolve {
 public:
  void reset(const Joints& rest_b);
  /// Throws Error when joints are not finite or the legs have no length.
  HybridFrame push(const Extraction& source, float dt);

 private:
  CopyTransfer copy_;
  double leg_sum_ = 0;
  int64_t frames_ = 0;
};

}  // namespace understudy::nn
