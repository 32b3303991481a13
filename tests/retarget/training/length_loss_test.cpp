// The loss of bone lengths: its value by hand, what it does not see, and its gradient.
#include "retarget/training/losses/skeleton_losses.hpp"

#include <gtest/gtest.h>

namespace understudy {
namespace {

using training::length_loss;

torch::Tensor some_joints(int seed) {
  torch::manual_seed(seed);
  return torch::randn({2, kJointCount, 3}, torch::kFloat64);
}

TEST(LengthLoss, IsTheMeanOverBones) {
  const auto truth = some_joints(1);
  auto longer = truth.clone();
  const auto shin = truth.select(1, LeftAnkle) - truth.select(1, LeftKnee);
  for (const int joint : {LeftAnkle, LeftFoot}) longer.select(1, joint) += 0.5 * shin;  // the foot goes along
  const double expected = 0.5 * shin.norm(2, -1).mean().item<double>() / (kJointCount - 1);
  EXPECT_NEAR(length_loss(longer, truth).item<double>(), expected, 1e-6);
}

TEST(LengthLoss, DoesNotSeeWhereTheBodyIsNorHowItIsTurned) {
  const auto truth = some_joints(2);
  const auto elsewhere = truth.flip(-1) + 3;  // axes exchanged, moved
  EXPECT_NEAR(length_loss(elsewhere, truth).item<double>(), 0, 1e-12);
}

TEST(LengthLoss, GradientIsThatOfFiniteDifferences) {
  const auto truth = some_joints(3), way = some_joints(4);
  const auto x = some_joints(5).requires_grad_();
  length_loss(x, truth).backward();
  const torch::NoGradGuard no_grad;
  const double step = 1e-6;
  const double slope =
      (length_loss(x + step * way, truth) - length_loss(x - step * way, truth)).item<double>() / (2 * step);
  EXPECT_NEAR((x.grad() * way).sum().item<double>(), slope, 1e-6);
  EXPECT_GT(std::abs(slope), 1e-4);
}

}  // namespace
}  // namespace understudy
