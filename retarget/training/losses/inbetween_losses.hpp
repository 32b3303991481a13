// Losses of in-betweening: everything counts in the frames that are not known, and more in short gaps, where
// a curve is nearly right.
#pragma once

#include <torch/torch.h>

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::training {

/// Mean length of vectors [..., 3].
inline torch::Tensor lengths(const torch::Tensor& vectors) {
  return vectors.square().sum(-1).add(1e-8).sqrt();
}

/// Mean over frames and joints of a figure [B, T, ...], each frame by its weight [B, T].
inline torch::Tensor weighed_mean(const torch::Tensor& figure, const torch::Tensor& weight) {
  const auto of_frames = figure.dim() > 2 ? figure.flatten(2).mean(-1) : figure;
  return (of_frames * weight).sum() / weight.sum().clamp_min(1e-6);
}

/// How far the n-th differences of two motions [B, T, J, 3] are apart, metres a frame^n; [B, T - n, J].
inline torch::Tensor difference_error(const torch::Tensor& joints, const torch::Tensor& truth, int64_t n) {
  return lengths((joints - truth).diff(n, 1));
}

/// Speed of those joints [B, T, K, 3] that truly stand, metres a frame: a standing foot moves less than
/// `slow` metres a frame. [B, T - 1, K].
inline torch::Tensor sliding(const torch::Tensor& feet, const torch::Tensor& true_feet, double slow) {
  const auto standing = (lengths(true_feet.diff(1, 1)) < slow).to(feet.dtype());
  return standing * lengths(feet.diff(1, 1));
}

}  // namespace understudy::training
