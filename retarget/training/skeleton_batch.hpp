// Training scans as tensors, and the loss of the extractor on them.
#pragma once

#include <vector>

#include "retarget/nn/modules/skeleton_extractor.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// Labels of B scans, in the normalised frame of ScanPatches.
struct SkeletonTruth {
  torch::Tensor joints;     ///< [B, 22, 3]
  torch::Tensor rotations;  ///< [B, 22, 6] world
  torch::Tensor parts;      ///< [B, M] int64, 22: not the body
  torch::Tensor seen;       ///< [B, 22] 1 where the cloud shows the joint, else 0
  torch::Tensor weights;    ///< [B, 22] of each joint in the losses of places and rotations; see joint_weight
};

/// 1 for a joint that lies in the cloud or near it, 0.2 from 0.6 leg lengths away: nobody can tell just where
/// it is, and it should not outweigh those that are seen.
float joint_weight(float away);

struct SkeletonBatch {
  nn::ExtractorInput input;
  torch::Tensor scale;   ///< [B] metres per normalised unit
  torch::Tensor centre;  ///< [B, 3] metres
  SkeletonTruth truth;
};

/// Scans cut into patches, as a batch. `recent`: the joints extracted before each, or empty.
SkeletonBatch make_batch(const std::vector<MadeScan>& scans, const std::vector<RecentJoints>& recent = {});
SkeletonBatch to_device(const SkeletonBatch& batch, const torch::Device& device);

/// A network without votes, paper 1's, has the mean squared error of its joints alone (L_skeleton).
LossSum skeleton_loss(const nn::ExtractorOutput& out, const SkeletonBatch& batch);

/// The extracted joints, world, metres.
std::vector<Joints> world_joints(const nn::ExtractorOutput& out, const SkeletonBatch& batch);

}  // namespace understudy::training
