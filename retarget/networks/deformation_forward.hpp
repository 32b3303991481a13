// The networks that bind a target, without LibTorch: what nn/modules/deformation computes, to rounding.
#pragma once

#include <memory>
#include <string>

#include "retarget/networks/kernels/kernels.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {

/// Of the networks' form: weights files of another version are refused.
constexpr int kDeformationVersion = 1;

/// Every point is seen from its own side of the body: the right half is mirrored, so that the networks learn
/// one half only. Within this distance of the middle (metres on an adult) both views are
/// blended.
constexpr double kMirrorBand = 0.02;

/// Pose features of SMPL: (R - I) of joints 1..21, row-major.
constexpr int kPoseFeatureCount = 189;
/// Numbers of a point besides the body code.
constexpr int kPointFeatureCount = 244;
constexpr int kContextPoints = 512;  ///< points that the summary of a surface is made of

/// Skin weights [N, 22] and offset basis [N, 567] of points of a target, both sides.
struct SurfaceValues {
  RowMatrix weights, basis;
};

class DeformationForward {
 public:
  /// Throws Error naming the file when it is missing, damaged, or of another network or version.
  explicit DeformationForward(const std::string& path, const Kernels& with = kernels());
  ~DeformationForward();
  /// points [N, 3] of a target in T-pose, its joints, and kContextPoints points spread over its surface;
  /// metres. Many points go to two threads.
  SurfaceValues evaluate(const Points& points, const Joints& joints, const Points& surface) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace understudy::nn
