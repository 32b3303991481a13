// Losses of motion transfer (paper 1, eq. 2).
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// L_cyccon: mean squared error of joints [B, T, 22, 3].
torch::Tensor cycle_loss(const torch::Tensor& joints, const torch::Tensor& truth);

/// L_rot: mean squared error of rotations [B, T, 22, 3, 3] in their 6D form.
torch::Tensor rotation_loss(const torch::Tensor& rotations, const torch::Tensor& truth);

/// L_smooth: mean squared error of joint velocities; joints [B, T, 22, 3], T >= 2; dt [B, T] seconds since
/// the frame before. A velocity is metres per 1/30 s, the paper's frame, whatever the rate.
torch::Tensor smoothness_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                              const torch::Tensor& dt);

/// L_adv of the generator (least squares): its motions should score 1.
torch::Tensor fooling_loss(const torch::Tensor& fake_scores);
/// L_adv of the discriminator: real motions score 1, made ones 0.
torch::Tensor telling_loss(const torch::Tensor& real_scores, const torch::Tensor& fake_scores);
/// Share of motions that the discriminator tells rightly, in 0..1.
double telling_accuracy(const torch::Tensor& real_scores, const torch::Tensor& fake_scores);

}  // namespace understudy::training
