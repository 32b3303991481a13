// Paper 3's losses, equations 8 to 17, each against numbers worked out by hand.
#include "retarget/training/losses/keypoint_losses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/training/losses/affinity_losses.hpp"

namespace understudy::training {
namespace {

/// One window, [1, T, K, 3]: the keypoints' x in each frame; y and z are 0.
torch::Tensor along_x(const std::vector<std::vector<float>>& frames) {
  const auto T = static_cast<int64_t>(frames.size()), K = static_cast<int64_t>(frames[0].size());
  auto places = torch::zeros({1, T, K, 3});
  for (int64_t t = 0; t < T; ++t)
    for (int64_t k = 0; k < K; ++k)
      places[0][t][k][0] = frames[static_cast<size_t>(t)][static_cast<size_t>(k)];
  return places;
}
/// Of two keypoints: a_01, a_10.
torch::Tensor affinity_of_two(float from_first, float from_second) {
  return torch::tensor({0.0f, from_first, from_second, 0.0f}).view({2, 2});
}
double value(const torch::Tensor& loss) {
  return loss.item<double>();
}

TEST(KeypointLosses, VolumeIsOfEachCellTheNearestKeypointSquared) {
  // Cells at 0, 1 and 4; keypoints at 0 and 3: 0, 1 and 1. The row that is not there lies far away.
  const auto cells = along_x({{0, 1, 4, 100}})[0], places = along_x({{0, 3}})[0];
  const auto counts = torch::tensor({1.0f, 1.0f, 1.0f, 0.0f}).view({1, 4});
  EXPECT_NEAR(value(volume_fitting_loss(cells, counts, places)), 2.0 / 3, 1e-6);
  // Each frame counts alike, however many cells it has: a second one with one cell, 2 from its keypoint.
  const auto both = torch::cat({cells, along_x({{2, 9, 9, 9}})[0]}),
             two = torch::cat({places, along_x({{0, 0}})[0]});
  const auto there = torch::cat({counts, torch::tensor({1.0f, 0.0f, 0.0f, 0.0f}).view({1, 4})});
  EXPECT_NEAR(value(volume_fitting_loss(both, there, two)), (2.0 / 3 + 4) / 2, 1e-5);
}

TEST(KeypointLosses, ReconstructionIsCrossEntropy) {
  // Occupied and believed with probability 3/4; empty and believed with 1/2.
  const auto logits = torch::tensor({static_cast<float>(std::log(3.0)), 0.0f});
  EXPECT_NEAR(value(reconstruction_loss(logits, torch::tensor({1.0f, 0.0f}))),
              (-std::log(0.75) - std::log(0.5)) / 2, 1e-6);
}

TEST(KeypointLosses, SparsityIsTheMeanOfTheMaps) {
  auto maps = torch::zeros({2, 2, 1, 1, 2});
  maps[0][1][0][0][0] = 4;
  maps[1][0][0][0][1] = 2;
  EXPECT_NEAR(value(sparsity_loss(maps)), 6.0 / 8, 1e-6);
}

TEST(KeypointLosses, WhatIsPhasedInGrowsEvenlyInItsShareOfTheTraining) {
  EXPECT_EQ(phased_in(0, 0.2, 0.6), 0);
  EXPECT_EQ(phased_in(0.2, 0.2, 0.6), 0);
  EXPECT_NEAR(phased_in(0.3, 0.2, 0.6), 0.25, 1e-12);
  EXPECT_EQ(phased_in(0.6, 0.2, 0.6), 1);
  EXPECT_EQ(phased_in(1, 0.2, 0.6), 1);
}

TEST(KeypointLosses, SeparationSeesWaysNotPlaces) {
  // The same way, a metre apart: exp(0) for both pairs.
  EXPECT_NEAR(value(separation_loss(along_x({{0, 1}, {0.02f, 1.02f}}))), 1, 1e-5);
  // Against each other by 0.01 from their means: 0.02 apart, exp(-1250 * 0.0004).
  EXPECT_NEAR(value(separation_loss(along_x({{0, 1.02f}, {0.02f, 1}}))), std::exp(-0.5), 1e-5);
  // Of three, two go one way: 2 of 6 ordered pairs are alike.
  const double apart = std::exp(-1250 * 0.0004);
  EXPECT_NEAR(value(separation_loss(along_x({{0, 1, 2.02f}, {0.02f, 1.02f, 2}}))), (2 + 4 * apart) / 6, 1e-5);
}

TEST(AffinityLosses, TheLargestOfTheMatricesCounts) {
  const auto both = torch::stack({affinity_of_two(0.2f, 0.9f), affinity_of_two(0.6f, 0.1f)});
  EXPECT_TRUE(torch::allclose(joined_affinity(both), affinity_of_two(0.6f, 0.9f)));
}

TEST(AffinityLosses, TrajectoriesThatAreAlikeCostNothing) {
  const auto ones = torch::ones({1, 3, 2});
  const auto A = affinity_of_two(0.5f, 0.25f);
  // Both speed up along x; places and speeds differ.
  EXPECT_NEAR(value(trajectory_loss(along_x({{0, 5}, {1, 7}, {3, 11}}), A, ones)), 0, 1e-6);
  // The second goes and speeds up the other way: C = 1/2 - (-1 - 1) / 4 = 1; (0.5 + 0.25) / K^2.
  EXPECT_NEAR(value(trajectory_loss(along_x({{0, 5}, {1, 3}, {3, -1}}), A, ones)), 0.75 / 4, 1e-6);
  // The same way, but it slows down: C = 1/2 - (1 - 1) / 4 = 1/2.
  EXPECT_NEAR(value(trajectory_loss(along_x({{0, 0}, {1, 3}, {3, 4}}), A, ones)), 0.75 / 8, 1e-6);
  // A faint keypoint's row counts less: 1 * 0.5 + 0.1 * 0.25.
  const auto faint = torch::tensor({1.0f, 0.1f}).expand({1, 3, 2});
  EXPECT_NEAR(value(trajectory_loss(along_x({{0, 5}, {1, 3}, {3, -1}}), A, faint)), 0.525 / 4, 1e-6);
}

TEST(AffinityLosses, LocalIsTheSquaredDistance) {
  const auto intensity = torch::tensor({1.0f, 0.5f}).expand({1, 2, 2});
  // 3 and 1 apart: mean over frames of (1 * 0.5 + 0.5 * 0.25) d^2, over K^2.
  EXPECT_NEAR(value(local_loss(along_x({{0, 3}, {1, 2}}), affinity_of_two(0.5f, 0.25f), intensity)),
              0.625 * (9 + 1) / 2 / 4, 1e-6);
}

TEST(AffinityLosses, TimeIsHowMuchTheSquaredDistanceChanges) {
  const auto ones = torch::ones({1, 2, 2});
  const auto A = affinity_of_two(0.5f, 0.25f);
  // 9 and 1, mean 5: 4 in each frame.
  EXPECT_NEAR(value(time_loss(along_x({{0, 3}, {1, 2}}), A, ones)), 0.75 * 4 / 4, 1e-6);
  EXPECT_NEAR(value(time_loss(along_x({{0, 3}, {7, 4}}), A, ones)), 0, 1e-6) << "three apart in both";
}

TEST(AffinityLosses, ComplexityIsWhatTheMatricesShare) {
  // Products 0.3 and 0.08, for (n, n') and (n', n).
  const auto both = torch::stack({affinity_of_two(0.5f, 0.8f), affinity_of_two(0.6f, 0.1f)});
  EXPECT_NEAR(value(complexity_loss(both)), 2 * std::hypot(0.3, 0.08), 1e-5);
  EXPECT_NEAR(value(complexity_loss(torch::stack({affinity_of_two(1, 0), affinity_of_two(0, 1)}))), 0, 1e-5);
}

/// Greatest difference of a loss's slope along a random way from its finite difference, and the slope.
void expect_gradient(const char* what, const std::function<torch::Tensor(const torch::Tensor&)>& loss) {
  torch::manual_seed(3);
  const auto x = 0.1 * torch::randn({1, 4, 5, 3}, torch::kFloat64), way = torch::randn_like(x);
  const auto at = x.clone().requires_grad_();
  loss(at).backward();
  const torch::NoGradGuard no_grad;
  const double step = 1e-6, slope = value(loss(x + step * way) - loss(x - step * way)) / (2 * step);
  EXPECT_NEAR(value((at.grad() * way).sum()), slope, 1e-5 * std::max(1.0, std::abs(slope))) << what;
  EXPECT_GT(std::abs(slope), 1e-6) << what;
}

TEST(KeypointLosses, GradientsAreThoseOfFiniteDifferences) {
  torch::manual_seed(4);
  const auto A = torch::rand({5, 5}, torch::kFloat64), alpha = torch::rand({1, 4, 5}, torch::kFloat64);
  const auto cells = torch::randn({4, 7, 3}, torch::kFloat64), counts = torch::ones({4, 7}, torch::kFloat64);
  expect_gradient("vol", [&](const torch::Tensor& x) { return volume_fitting_loss(cells, counts, x[0]); });
  expect_gradient("sep", [&](const torch::Tensor& x) { return separation_loss(x, 5); });
  expect_gradient("traj", [&](const torch::Tensor& x) { return trajectory_loss(x, A, alpha); });
  expect_gradient("local", [&](const torch::Tensor& x) { return local_loss(x, A, alpha); });
  expect_gradient("time", [&](const torch::Tensor& x) { return time_loss(x, A, alpha); });
  const auto there = (torch::rand({1, 4, 5, 3}, torch::kFloat64) > 0.5).to(torch::kFloat64);
  expect_gradient("recon", [&](const torch::Tensor& x) { return reconstruction_loss(x, there); });
  expect_gradient("complex", [&](const torch::Tensor& x) { return complexity_loss(x.squeeze(0)); });
}

}  // namespace
}  // namespace understudy::training
