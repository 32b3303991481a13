// The losses of skeleton extraction.
#pragma once

#include "retarget/nn/modules/skeleton_extractor.hpp"

namespace understudy::training {

/// What is true of B scans, in the normalised frame of ScanPatches.
struct SkeletonTruth {
  torch::Tensor joints;     ///< [B, 22, 3]
  torch::Tensor rotations;  ///< [B, 22, 6] world
  torch::Tensor parts;      ///< [B, M] int64, 22: not the body
};

struct SkeletonLoss {
  torch::Tensor total, joint, vote, part, rotation, spread;
};

/// Mean distance, smooth at zero, of two sets of points [..., 3].
torch::Tensor mean_distance(const torch::Tensor& a, const torch::Tensor& b);
/// Votes count near their joint only: mean |vote - joint| over patches within `reach` of it.
torch::Tensor vote_loss(const torch::Tensor& votes, const torch::Tensor& centres, const torch::Tensor& joints,
                        double reach);
/// Negative log likelihood of the error under a Laplace-like law of width exp(log_spread); the error itself
/// gets no gradient, so that confidence never trades against precision.
torch::Tensor spread_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                          const torch::Tensor& log_spread);

SkeletonLoss skeleton_loss(const nn::ExtractorOutput& out, const torch::Tensor& centres,
                           const SkeletonTruth& truth);

}  // namespace understudy::training
