// The losses of skeleton extraction.
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// Mean distance, smooth at zero, of two sets of points [..., 3].
inline torch::Tensor mean_distance(const torch::Tensor& a, const torch::Tensor& b) {
  return ((a - b).square().sum(-1) + 1e-6).sqrt().mean();
}

/// Votes [B, M, 22, 3] count near their joint only: mean distance over patches within `reach` of it. Patch
/// centres [B, M, 3], joints [B, 22, 3].
inline torch::Tensor vote_loss(const torch::Tensor& votes, const torch::Tensor& centres,
                               const torch::Tensor& joints, double reach) {
  const auto to_joint = joints.unsqueeze(1) - centres.unsqueeze(2);                   // [B, M, 22, 3]
  const auto near = (to_joint.square().sum(-1) < reach * reach).to(torch::kFloat32);  // [B, M, 22]
  const auto error = ((votes - joints.unsqueeze(1)).square().sum(-1) + 1e-6).sqrt();  // [B, M, 22]
  return (near * error).sum() / near.sum().clamp_min(1.0);
}

/// Negative log likelihood of errors [B, K] under a Laplace-like law of width exp(log_spread); the error
/// itself gets no gradient, so that confidence never trades against precision.
inline torch::Tensor spread_loss(const torch::Tensor& error, const torch::Tensor& log_spread) {
  return (error.detach() * torch::exp(-log_spread) + log_spread).mean();
}

}  // namespace understudy::training
