// The losses of skeleton extraction, and of parts seen from near: arms, legs, hands, head and feet.
#pragma once

#include <torch/torch.h>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::training {

/// Mean of values, each times its weight, of the same shape; undefined weights are 1.
inline torch::Tensor weighted_mean(const torch::Tensor& values, const torch::Tensor& weights) {
  return weights.defined() ? (values * weights).mean() : values.mean();
}

/// Mean distance, smooth at zero, of two sets of points [..., 3], which may have weights [...].
inline torch::Tensor mean_distance(const torch::Tensor& a, const torch::Tensor& b,
                                   const torch::Tensor& weights = {}) {
  return weighted_mean(((a - b).square().sum(-1) + 1e-6).sqrt(), weights);
}

/// Mean squared difference of coordinates [..., 3].
inline torch::Tensor square_loss(const torch::Tensor& joints, const torch::Tensor& truth) {
  return (joints - truth).square().mean();
}

/// Cross entropy of logits [B, M, P] against labels [B, M]: which part each patch belongs to.
inline torch::Tensor label_loss(const torch::Tensor& logits, const torch::Tensor& labels) {
  return torch::nn::functional::cross_entropy(logits.flatten(0, 1), labels.flatten());
}

/// Mean difference of rotations' 6D entries [..., 6], which may have weights [...].
inline torch::Tensor columns_loss(const torch::Tensor& rotations, const torch::Tensor& truth,
                                  const torch::Tensor& weights = {}) {
  return weighted_mean((rotations - truth).abs().mean(-1), weights);
}

/// Binary cross entropy of logits [B, 22] against which joints the scan shows, 1 or 0 [B, 22].
inline torch::Tensor visibility_loss(const torch::Tensor& logits, const torch::Tensor& seen) {
  return torch::nn::functional::binary_cross_entropy_with_logits(logits, seen);
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

/// Of each joint but the pelvis what its parent has, along `axis` of 22.
inline torch::Tensor at_parents(const torch::Tensor& of_joints, int64_t axis) {
  const std::vector<int64_t> parents(kParents.begin() + 1, kParents.end());
  return of_joints.index_select(axis, torch::tensor(parents, torch::device(of_joints.device())));
}

/// Lengths of the bones from the joints' parents, [..., 21]. joints [..., 22, 3]. Smooth at zero.
inline torch::Tensor bone_lengths(const torch::Tensor& joints) {
  const auto bones = joints.narrow(-2, 1, kJointCount - 1) - at_parents(joints, -2);
  return (bones.square().sum(-1) + 1e-6).sqrt();
}

/// Mean difference of bone lengths, in the joints' unit: joints that are each a little off may leave a thigh
/// too long, and the path with it. joints, truth [..., 22, 3]; a bone has the lesser of its joints' weights
/// [..., 22], if there are any.
inline torch::Tensor length_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                                 const torch::Tensor& weights = {}) {
  const auto error = (bone_lengths(joints) - bone_lengths(truth)).abs();
  if (!weights.defined()) return error.mean();
  return weighted_mean(error,
                       torch::minimum(weights.narrow(-1, 1, kJointCount - 1), at_parents(weights, -1)));
}

/// How far joints are off, [B, K], in leg lengths. Rows of `output` and `truth` as PartNet gives them.
inline torch::Tensor place_error(const torch::Tensor& output, const torch::Tensor& truth) {
  return (output.narrow(2, 6, 3) - truth.narrow(2, 6, 3)).square().sum(2).add(1e-8).sqrt();
}

/// output [B, K, 10], truth [B, K, 9].
inline torch::Tensor part_loss(const torch::Tensor& output, const torch::Tensor& truth) {
  const auto turn = (output.narrow(2, 0, 6) - truth.narrow(2, 0, 6)).abs().mean();
  const auto away = place_error(output, truth);
  return turn + 5 * away.mean() + 0.01 * spread_loss(away, output.select(2, 9));
}

}  // namespace understudy::training
