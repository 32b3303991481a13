// Training scans as tensors.
#pragma once

#include <vector>

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/training/scan_maker.hpp"
#include "retarget/training/skeleton_loss.hpp"

namespace understudy::training {

struct SkeletonBatch {
  nn::ExtractorInput input;
  torch::Tensor scale;   ///< [B] metres per normalised unit
  torch::Tensor centre;  ///< [B, 3] metres
  SkeletonTruth truth;
};

/// Scans cut into patches and put beside each other. `recent`: what was seen before each, or empty.
SkeletonBatch make_batch(const std::vector<MadeScan>& scans, const std::vector<RecentJoints>& recent = {});
SkeletonBatch to_device(const SkeletonBatch& batch, const torch::Device& device);

/// The joints that the network saw, world, metres.
std::vector<Joints> world_joints(const nn::ExtractorOutput& out, const SkeletonBatch& batch);

/// Figures of the extractor on a batch, in metres and degrees.
struct SkeletonScore {
  double joint_mm = 0, swap_rate = 0, rotation_deg = 0;
};
SkeletonScore score(const nn::ExtractorOutput& out, const SkeletonBatch& batch);

}  // namespace understudy::training
