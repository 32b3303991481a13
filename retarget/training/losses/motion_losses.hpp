// Losses of motion transfer (paper 1, eq. 2).
#pragma once

#include <torch/torch.h>

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::training {

/// L_cyccon: mean squared error of joints [B, T, 22, 3].
inline torch::Tensor cycle_loss(const torch::Tensor& joints, const torch::Tensor& truth) {
  return (joints - truth).square().mean();
}

/// L_rot: mean squared error of rotations [B, T, 22, 3, 3] in their 6D form.
inline torch::Tensor rotation_loss(const torch::Tensor& rotations, const torch::Tensor& truth) {
  return (nn::rotations_to_6d(rotations) - nn::rotations_to_6d(truth)).square().mean();
}

/// L_smooth: mean squared error of joint velocities; joints [B, T, 22, 3], T >= 2; dt [B, T] seconds since
/// the frame before. A velocity is metres per 1/30 s, the paper's frame, whatever the rate.
inline torch::Tensor smoothness_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                                     const torch::Tensor& dt) {
  const auto error = joints - truth;
  const auto change = error.slice(1, 1) - error.slice(1, 0, error.size(1) - 1);  // of the velocity, times dt
  return (change / (30 * dt.slice(1, 1)).unsqueeze(-1).unsqueeze(-1)).square().mean();
}

/// L_adv of the generator (least squares): its motions should score 1.
inline torch::Tensor adversarial_loss(const torch::Tensor& fake_scores) {
  return (fake_scores - 1).square().mean();
}

/// L_adv of the discriminator: real motions score 1, made ones 0.
inline torch::Tensor discriminator_loss(const torch::Tensor& real_scores, const torch::Tensor& fake_scores) {
  return 0.5 * ((real_scores - 1).square().mean() + fake_scores.square().mean());
}

/// Share of motions that the discriminator classes rightly, in 0..1.
inline double discriminator_accuracy(const torch::Tensor& real_scores, const torch::Tensor& fake_scores) {
  const auto right = real_scores.gt(0.5).sum() + fake_scores.le(0.5).sum();
  return right.item<double>() / static_cast<double>(real_scores.numel() + fake_scores.numel());
}

}  // namespace understudy::training
