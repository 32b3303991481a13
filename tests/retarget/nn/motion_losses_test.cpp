// Losses and discriminator of motion transfer.
#include <gtest/gtest.h>

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/training/losses/motion_losses.hpp"
#include "retarget/training/motion_step.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

torch::Tensor doubles(at::IntArrayRef sizes) {
  return torch::randn(sizes, torch::kFloat64);
}

TEST(CycleLoss, IsTheMeanSquareAndItsGradientIsRight) {
  const auto a = torch::zeros({1, 1, kJointCount, 3});
  EXPECT_NEAR(cycle_loss(a + 0.1, a).item<float>(), 0.01f, 1e-6f);
  torch::manual_seed(1);
  const auto truth = doubles({1, 2, kJointCount, 3});
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return cycle_loss(x, truth); },
                           doubles({1, 2, kJointCount, 3})),
            1e-7);
}

TEST(RotationLoss, GradientIsThatOfFiniteDifferences) {
  torch::manual_seed(2);
  const auto truth = random_rotations(1, 1, torch::kFloat64);
  const auto value = [&](const torch::Tensor& x) { return rotation_loss(nn::rotations_from_6d(x), truth); };
  EXPECT_LT(gradient_error(value, doubles({1, 1, kJointCount, 6})), 1e-6);
  EXPECT_EQ(rotation_loss(truth, truth).item<double>(), 0);
}

TEST(SmoothnessLoss, SeesVelocitiesOnly) {
  torch::manual_seed(3);
  const auto a = doubles({1, 4, kJointCount, 3}), dt = torch::full({1, 4}, 1.0 / 30, torch::kFloat64);
  EXPECT_NEAR(smoothness_loss(a + 0.5, a, dt).item<double>(), 0, 1e-12);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return smoothness_loss(x, a, dt); },
                           doubles({1, 4, kJointCount, 3})),
            1e-7);
}

TEST(SmoothnessLoss, IsTheSameAtAnyRate) {
  const auto slow = torch::arange(4, torch::kFloat32).view({1, 4, 1, 1}).expand({1, 4, kJointCount, 3});
  const auto still = torch::zeros_like(slow);
  const auto at_30 = smoothness_loss(slow, still, torch::full({1, 4}, 1.0f / 30));
  const auto at_60 = smoothness_loss(0.5 * slow, still, torch::full({1, 4}, 1.0f / 60));
  EXPECT_NEAR(at_30.item<float>(), at_60.item<float>(), 1e-5f);
}

TEST(AdversarialLosses, GradientsAreThoseOfFiniteDifferences) {
  torch::manual_seed(4);
  const auto fake = doubles({6});
  EXPECT_LT(gradient_error([](const torch::Tensor& x) { return adversarial_loss(x); }, doubles({6})), 1e-7);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return discriminator_loss(x, fake); }, doubles({6})),
            1e-7);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return discriminator_loss(fake, x); }, doubles({6})),
            1e-7);
}

TEST(AdversarialLosses, AccuracyCountsBothKinds) {
  EXPECT_DOUBLE_EQ(discriminator_accuracy(torch::tensor({0.9f, 0.2f}), torch::tensor({0.1f, 0.3f})), 0.75);
}

TEST(MotionDiscriminator, ItsGradientReachesTheMotionNetwork) {
  torch::manual_seed(5);
  nn::MotionGru net(nn::MotionGruOptions{16, 1});
  MotionDiscriminator discriminator(16);
  const auto input = random_input(2, 20);
  nn::MotionState state;
  const auto made = nn::forward_kinematics(input.rest, net->forward(input, state)).joints;
  adversarial_loss(discriminator->forward(made, input.rest, input.dt)).backward();
  double size = 0;
  for (const auto& parameter : net->parameters()) {
    ASSERT_TRUE(parameter.grad().defined());
    size += parameter.grad().square().sum().item<double>();
  }
  EXPECT_GT(size, 1e-8);
}

TEST(MotionDiscriminator, LearnsToTellStillFromMoving) {
  torch::manual_seed(6);
  MotionDiscriminator discriminator(16);
  torch::optim::Adam optimizer(discriminator->parameters(), 5e-3);
  double accuracy = 0;
  for (int i = 0; i < 80; ++i) {
    const auto input = random_input(8, 20);
    const auto still = input.joints.slice(1, 0, 1).expand_as(input.joints);
    const auto real = discriminator->forward(input.joints, input.rest, input.dt);
    const auto fake = discriminator->forward(still, input.rest, input.dt);
    optimizer.zero_grad();
    discriminator_loss(real, fake).backward();
    optimizer.step();
    if (i >= 70) accuracy += discriminator_accuracy(real, fake) / 10;
  }
  EXPECT_GE(accuracy, 0.8);
}

}  // namespace
}  // namespace understudy
