#include "retarget/training/losses/motion_losses.hpp"

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::training {

torch::Tensor cycle_loss(const torch::Tensor& joints, const torch::Tensor& truth) {
  return (joints - truth).square().mean();
}

torch::Tensor rotation_loss(const torch::Tensor& rotations, const torch::Tensor& truth) {
  return (nn::rotations_to_6d(rotations) - nn::rotations_to_6d(truth)).square().mean();
}

torch::Tensor smoothness_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                              const torch::Tensor& dt) {
  const auto error = joints - truth;
  const auto change = error.slice(1, 1) - error.slice(1, 0, error.size(1) - 1);  // of the velocity, times dt
  return (change / (30 * dt.slice(1, 1)).unsqueeze(-1).unsqueeze(-1)).square().mean();
}

torch::Tensor fooling_loss(const torch::Tensor& fake_scores) {
  return (fake_scores - 1).square().mean();
}

torch::Tensor telling_loss(const torch::Tensor& real_scores, const torch::Tensor& fake_scores) {
  return 0.5 * ((real_scores - 1).square().mean() + fake_scores.square().mean());
}

double telling_accuracy(const torch::Tensor& real_scores, const torch::Tensor& fake_scores) {
  const auto right = real_scores.gt(0.5).sum() + fake_scores.le(0.5).sum();
  return right.item<double>() / static_cast<double>(real_scores.numel() + fake_scores.numel());
}

}  // namespace understudy::training
