// The forward pass of the extraction network "dense" without LibTorch: what nn/modules/skeleton_extractor
// computes, to rounding.
#pragma once

#include <memory>
#include <string>

#include "retarget/networks/kernels/kernels.hpp"
#include "retarget/networks/scan_patches.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

constexpr int kSkeletonVersion = 1;
/// What weights that were trained before it existed lack: they say nothing of what is seen.
constexpr const char* kVisibilityHead = "net.visibility_head.";

/// Output in the normalised frame of ScanPatches.
struct ExtractorForwardOutput {
  Joints joints;
  Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor> rotations;  ///< world, relative to the T-pose, as 6D
  Confidence log_spread;                                            ///< log of the expected error
  std::optional<Confidence> visibility;  ///< logits; where the weights have that head
};

/// Joints seen before, in the frame of `patches`, and how they moved: [22, 6]; 0 where nothing is known.
Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor> normalised_past(const RecentJoints& recent,
                                                                      const ScanPatches& patches);

class ExtractorForward {
 public:
  /// Throws Error naming the file when it is missing, damaged, or of another network or version.
  explicit ExtractorForward(const std::string& path, const Kernels& with = kernels());
  ~ExtractorForward();
  /// One thread at a time. Keeps its buffers between calls.
  ExtractorForwardOutput run(const ScanPatches& patches, const RecentJoints& recent);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::nn
