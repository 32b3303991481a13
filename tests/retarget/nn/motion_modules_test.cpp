// The forward-kinematics layer and the recurrent network of motion transfer.
#include <gtest/gtest.h>

#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;

Joints joints_of(const torch::Tensor& tensor) {
  return Eigen::Map<const Joints>(tensor.contiguous().data_ptr<float>());
}

TEST(ForwardKinematicsLayer, AgreesWithTheSkeletons) {
  torch::manual_seed(1);
  const auto rest = rest_joints(2);
  const auto local = random_rotations(2, 3);
  const auto made = nn::forward_kinematics(rest, local);
  for (int64_t b = 0; b < 2; ++b)
    for (int64_t t = 0; t < 3; ++t) {
      Pose pose;
      for (int j = 0; j < kJointCount; ++j)
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) pose.local[j](r, c) = local[b][t][j][r][c].item<float>();
      const auto truth = forward_kinematics(joints_of(rest[b]), pose);
      EXPECT_LT((joints_of(made.joints[b][t]) - truth.joints).cwiseAbs().maxCoeff(), 1e-5f);
      EXPECT_NEAR(made.global[b][t][LeftWrist][1][2].item<float>(), truth.global[LeftWrist](1, 2), 1e-5f);
    }
}

TEST(ForwardKinematicsLayer, GradientIsThatOfFiniteDifferences) {
  torch::manual_seed(2);
  const auto rest = rest_joints(1, torch::kFloat64);
  const auto local = random_rotations(1, 1, torch::kFloat64);
  const auto weight = torch::randn({1, 1, kJointCount, 3}, torch::kFloat64);
  const auto turn = torch::randn({1, 1, kJointCount, 3, 3}, torch::kFloat64);
  const auto value = [&](const torch::Tensor& r, const torch::Tensor& l) {
    const auto made = nn::forward_kinematics(r, l);
    return (made.joints * weight).sum() + (made.global * turn).sum();
  };
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return value(rest, x); }, local), 1e-6);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return value(x, local); }, rest), 1e-6);
}

TEST(RotationsFrom6d, AreRotationsAndComeBack) {
  torch::manual_seed(3);
  const auto R = nn::rotations_from_6d(torch::randn({50, 6}));
  EXPECT_TRUE(
      torch::allclose(torch::matmul(R.transpose(-1, -2), R), torch::eye(3).expand({50, 3, 3}), 0, 1e-5));
  EXPECT_GT(torch::det(R).min().item<float>(), 0.999f);
  EXPECT_TRUE(torch::allclose(nn::rotations_from_6d(nn::rotations_to_6d(R)), R, 0, 1e-5));
}

TEST(RotationsFrom6d, GradientIsThatOfFiniteDifferences) {
  torch::manual_seed(4);
  const auto weight = torch::randn({4, 3, 3}, torch::kFloat64);
  const auto value = [&](const torch::Tensor& x) { return (nn::rotations_from_6d(x) * weight).sum(); };
  EXPECT_LT(gradient_error(value, torch::randn({4, 6}, torch::kFloat64)), 1e-6);
}

TEST(RotationsFromQuaternions, AreThoseOfEigenAtAnyLength) {
  torch::manual_seed(5);
  const auto q = torch::randn({20, 4});
  const auto R = nn::rotations_from_quaternions(q);
  for (int64_t i = 0; i < 20; ++i) {
    const float* p = q[i].data_ptr<float>();
    const Mat3 truth = Eigen::Quaternionf(p[0], p[1], p[2], p[3]).normalized().toRotationMatrix();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(R[i][r][c].item<float>(), truth(r, c), 1e-5f);
  }
  const auto weight = torch::randn({4, 3, 3}, torch::kFloat64);
  const auto value = [&](const torch::Tensor& x) {
    return (nn::rotations_from_quaternions(x) * weight).sum();
  };
  EXPECT_LT(gradient_error(value, torch::randn({4, 4}, torch::kFloat64)), 1e-6);
}

nn::MotionGru network(uint64_t seed) {
  torch::manual_seed(seed);
  nn::MotionGru net(nn::MotionGruOptions{/*hidden=*/32, /*layers=*/2});
  net->eval();
  return net;
}

torch::Tensor run(nn::MotionGru& net, const nn::MotionInput& input) {
  const torch::NoGradGuard no_grad;
  nn::MotionState state;
  return net->forward(input, state);
}

nn::MotionInput frames_of(const nn::MotionInput& input, int64_t first, int64_t last) {
  return {input.joints.slice(1, first, last), input.leg.slice(1, first, last), input.dt.slice(1, first, last),
          input.rest};
}

TEST(MotionGru, LaterFramesChangeNothingBefore) {
  auto net = network(5);
  const auto input = random_input(2, 12);
  auto other = input;
  other.joints = input.joints.clone();
  other.joints.slice(1, 8) += torch::randn({2, 4, kJointCount, 3});
  const auto a = run(net, input), b = run(net, other);
  EXPECT_TRUE(torch::equal(a.slice(1, 0, 8), b.slice(1, 0, 8)));
  EXPECT_FALSE(torch::allclose(a.slice(1, 8), b.slice(1, 8)));
}

TEST(MotionGru, FrameByFrameIsTheSameAsAtOnce) {
  auto net = network(6);
  const auto input = random_input(2, 10);
  const auto at_once = run(net, input);
  const torch::NoGradGuard no_grad;
  nn::MotionState state;
  for (int64_t t = 0; t < 10; ++t) {
    const auto frame = net->forward(frames_of(input, t, t + 1), state);
    EXPECT_TRUE(torch::allclose(frame, at_once.slice(1, t, t + 1), 0, 1e-5)) << "frame " << t;
  }
}

TEST(MotionGru, RemembersThePast) {
  auto net = network(7);
  const auto input = random_input(1, 10);
  const auto alone = run(net, frames_of(input, 9, 10));
  EXPECT_FALSE(torch::allclose(alone, run(net, input).slice(1, 9), 0, 1e-4));
}

TEST(MotionGru, TurningTheSourceTurnsTheResult) {
  auto net = network(8);
  const auto input = random_input(2, 6);
  const Mat3 yaw = rotation_about_y(1.1f);
  auto Y = torch::empty({3, 3});
  for (int i = 0; i < 9; ++i) Y[i / 3][i % 3] = yaw(i / 3, i % 3);
  auto turned = input;
  turned.joints = torch::matmul(input.joints, Y.t()) + 5;  // and moved
  const auto a = run(net, input), b = run(net, turned);
  EXPECT_TRUE(torch::allclose(torch::matmul(Y, a.select(2, 0)), b.select(2, 0), 0, 1e-4));
  EXPECT_TRUE(torch::allclose(a.slice(2, 1), b.slice(2, 1), 0, 1e-4));
}

TEST(MotionGru, TheSizesOfBodiesDoNotMatter) {
  auto net = network(9);
  const auto input = random_input(1, 6);
  const nn::MotionInput grown{input.joints * 2, input.leg * 2, input.dt, input.rest * 3};
  EXPECT_TRUE(torch::allclose(run(net, input), run(net, grown), 0, 1e-4));
}

TEST(MotionGru, HeadingOfTheTPoseIsTheIdentity) {
  const auto rest = rest_joints(2).unsqueeze(1);
  EXPECT_TRUE(torch::allclose(nn::headings(rest), torch::eye(3).expand({2, 1, 3, 3}), 0, 1e-6));
}

}  // namespace
}  // namespace understudy
