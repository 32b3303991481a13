// W_net, O_net and their losses.
#include "retarget/nn/modules/deformation.hpp"

#include <gtest/gtest.h>

#include "retarget/skeleton/skinning.hpp"
#include "retarget/training/deformation_data.hpp"
#include "retarget/training/losses/deformation_losses.hpp"
#include "tests/retarget/nn/deformation_support.hpp"

namespace understudy {
namespace {

using torch::Tensor;

Tensor joints_tensor() {
  const Joints joints = testing::adult_joints();
  return torch::from_blob(const_cast<float*>(joints.data()), {1, kJointCount, 3}).clone();
}

nn::DeformationNet small_net() {
  torch::manual_seed(3);
  nn::DeformationOptions options;
  options.width = 32;
  options.code = 16;
  return nn::DeformationNet(options);
}

/// Largest difference between the gradient of f at x and central differences, over the gradient's largest
/// entry.
double gradient_error(const std::function<Tensor(const Tensor&)>& f, const Tensor& at) {
  Tensor x = at.detach().clone().to(torch::kFloat64).requires_grad_(true);
  f(x).backward();
  const Tensor gradient = x.grad().flatten();
  const torch::NoGradGuard no_grad;
  Tensor numeric = torch::zeros_like(gradient), flat = x.detach().clone();
  constexpr double kStep = 1e-6;
  for (int64_t i = 0; i < flat.numel(); ++i) {
    Tensor plus = flat.clone(), minus = flat.clone();
    plus.view(-1)[i] += kStep;
    minus.view(-1)[i] -= kStep;
    numeric[i] = (f(plus) - f(minus)) / (2 * kStep);
  }
  return ((gradient - numeric).abs().max() / gradient.abs().max().clamp_min(1e-12)).item<double>();
}

TEST(DeformationNet, WeightsSumToOne) {
  auto net = small_net();
  const Tensor joints = joints_tensor(), points = torch::randn({1, 50, 3}) * 0.5;
  const auto out = net->forward(points, joints, net->body_code(joints, points));
  EXPECT_TRUE(torch::allclose(out.log_weights.exp().sum(-1), torch::ones({1, 50}), 0, 1e-5));
  EXPECT_TRUE((out.log_weights.exp() >= 0).all().item<bool>());
}

TEST(DeformationNet, SurfaceSummaryIgnoresPointOrder) {
  auto net = small_net();
  const Tensor joints = joints_tensor(), surface = torch::randn({1, 64, 3}) * 0.5;
  const Tensor shuffled = surface.index_select(1, torch::randperm(64));
  EXPECT_TRUE(torch::allclose(net->body_code(joints, surface), net->body_code(joints, shuffled), 0, 1e-5));
}

TEST(DeformationNet, EachPointIsSeenAlone) {
  auto net = small_net();
  const Tensor joints = joints_tensor(), points = torch::randn({1, 64, 3}) * 0.5;
  const Tensor code = net->body_code(joints, points);
  const auto all = net->forward(points, joints, code),
             some = net->forward(points.slice(1, 10, 20), joints, code);
  EXPECT_TRUE(torch::allclose(all.log_weights.slice(1, 10, 20), some.log_weights, 0, 1e-4));
  EXPECT_TRUE(torch::allclose(all.basis.slice(1, 10, 20), some.basis, 0, 1e-5));
}

TEST(PointFeatures, StayWhenBodyMovesOrGrows) {
  const Tensor joints = joints_tensor(), points = torch::randn({1, 20, 3}) * 0.5;
  const Tensor moved = torch::tensor({1.0f, -2.0f, 0.5f});
  const Tensor a = nn::point_features(points, joints);
  EXPECT_EQ(a.size(-1), nn::kPointFeatureCount);
  EXPECT_TRUE(torch::allclose(a, nn::point_features(points + moved, joints + moved), 0, 1e-3));
  EXPECT_TRUE(torch::allclose(a, nn::point_features(points * 1.7, joints * 1.7), 0, 1e-3));
}

TEST(PointFeatures, GradientMatchesFiniteDifferences) {
  const Tensor joints = joints_tensor().to(torch::kFloat64);
  const auto f = [&](const Tensor& x) { return nn::point_features(x, joints).sin().sum(); };
  torch::manual_seed(1);
  EXPECT_LT(gradient_error(f, torch::randn({1, 3, 3}) * 0.4), 1e-5);
}

TEST(BindSurface, MirroredTargetGetsMirroredAnswer) {
  auto net = small_net();
  torch::manual_seed(2);
  const Tensor joints = joints_tensor() + 0.02 * torch::randn({1, kJointCount, 3});
  const Tensor points = torch::randn({1, 80, 3}) * 0.4, middle = nn::middle_plane(joints);
  const auto here = nn::bind_surface(net, points[0], joints[0], points[0]);
  const Tensor there_points = nn::mirror_points(points, middle);
  const auto there =
      nn::bind_surface(net, there_points[0], nn::mirror_joints(joints, middle)[0], there_points[0]);
  EXPECT_TRUE(torch::allclose(nn::mirror_weights(here.weights), there.weights, 0, 1e-5));
  EXPECT_TRUE(torch::allclose(nn::mirror_basis(here.basis), there.basis, 0, 1e-6));
}

TEST(BindSurface, HasNoSeamInTheMiddle) {
  auto net = small_net();
  const Tensor joints = joints_tensor();
  Tensor points = torch::zeros({201, 3});
  points.select(1, 0).copy_(torch::linspace(-0.05, 0.05, 201));  // half a millimetre apart
  const auto bound = nn::bind_surface(net, points, joints[0], points);
  const Tensor jump = (bound.weights.slice(0, 1) - bound.weights.slice(0, 0, 200)).abs().max();
  EXPECT_LT(jump.item<double>(), 0.02);
}

TEST(BindSurface, OffsetsOfAGiantGrowWithHim) {
  auto net = small_net();
  const Tensor joints = joints_tensor()[0], points = torch::randn({40, 3}) * 0.4;
  const auto giant = nn::bind_surface(net, points * 3, joints * 3, points * 3);
  const auto titan = nn::bind_surface(net, points * 6, joints * 6, points * 6);
  EXPECT_TRUE(torch::allclose(giant.weights, titan.weights, 0, 1e-4));
  EXPECT_TRUE(torch::allclose(giant.basis * 2, titan.basis, 1e-3, 1e-5));
}

TEST(MirrorBasis, OffsetsInAMirrorAreMirrored) {
  const Pose pose = testing::random_test_pose(5);
  const auto features = [](const Pose& p) {
    Eigen::VectorXf f = pose_features(p.local);
    return torch::from_blob(f.data(), {1, 1, nn::kPoseFeatureCount}).clone();
  };
  const Tensor basis = torch::randn({1, 7, 3 * nn::kPoseFeatureCount});
  const Tensor offsets = nn::pose_offsets(basis, features(pose));
  const Tensor mirrored_offsets = nn::pose_offsets(nn::mirror_basis(basis), features(mirrored(pose)));
  const Tensor flip = torch::tensor({-1.f, 1.f, 1.f}).view({1, 1, 3, 1});
  EXPECT_TRUE(torch::allclose(offsets * flip, mirrored_offsets, 1e-4, 1e-4));
}

TEST(BlendSkin, EqualsLinearBlendSkinning) {
  const ShapedBody body = testing::octahedron_body().shaped(Eigen::VectorXf());
  const Pose pose = testing::random_test_pose(9);
  Pose centred = pose;
  centred.root = Vec3::Zero();
  auto transforms = joint_transforms(body.joints, forward_kinematics(body.joints, centred));
  const auto tensor = [](const auto& m) {
    return torch::from_blob(const_cast<float*>(m.data()), {m.rows(), m.cols()}).clone();
  };
  const Tensor posed =
      nn::blend_skin(tensor(body.weights).unsqueeze(0), tensor(body.vertices).view({1, -1, 3, 1}),
                     tensor(transforms).view({1, 1, kJointCount, 12}));
  const Points expected = linear_blend_skinning(body.vertices, body.weights, body.joints,
                                                forward_kinematics(body.joints, centred));
  EXPECT_TRUE(torch::allclose(posed[0].select(1, 0), tensor(expected), 0, 1e-5));
}

TEST(FilmBlock, GradientMatchesFiniteDifferences) {
  torch::manual_seed(4);
  nn::FilmBlock block(6, 3);
  block->to(torch::kFloat64);
  const Tensor code = torch::randn({1, 3}, torch::kFloat64),
               weight = torch::randn({1, 4, 6}, torch::kFloat64);
  EXPECT_LT(gradient_error([&](const Tensor& x) { return (block(x, code) * weight).sum(); },
                           torch::randn({1, 4, 6})),
            1e-6);
  const Tensor h = torch::randn({1, 4, 6}, torch::kFloat64);
  EXPECT_LT(
      gradient_error([&](const Tensor& x) { return (block(h, x) * weight).sum(); }, torch::randn({1, 3})),
      1e-6);
}

TEST(BlendSkin, GradientMatchesFiniteDifferences) {
  torch::manual_seed(5);
  const auto options = torch::kFloat64;
  const Tensor weights = torch::rand({1, 3, kJointCount}, options),
               rest = torch::randn({1, 3, 3, 2}, options);
  const Tensor transforms = torch::randn({1, 2, kJointCount, 12}, options);
  EXPECT_LT(gradient_error([&](const Tensor& x) { return nn::blend_skin(x, rest, transforms).sin().sum(); },
                           weights),
            1e-5);
  EXPECT_LT(gradient_error(
                [&](const Tensor& x) { return nn::blend_skin(weights, x, transforms).sin().sum(); }, rest),
            1e-5);
}

TEST(DeformationLosses, GradientsMatchFiniteDifferences) {
  torch::manual_seed(6);
  const auto options = torch::kFloat64;
  const Tensor truth = torch::randn({1, 4, 2, 3}, options), posed = torch::randn({1, 4, 2, 3});
  EXPECT_LT(gradient_error([&](const Tensor& x) { return training::geometry_loss(x, truth); }, posed), 1e-5);
  EXPECT_LT(gradient_error([&](const Tensor& x) { return training::edge_loss(x, truth); }, posed), 1e-5);
  const Tensor offsets = torch::randn({1, 4, 3, 2}, options);
  EXPECT_LT(gradient_error([&](const Tensor& x) { return training::offset_loss(x, offsets); },
                           torch::randn({1, 4, 3, 2})),
            1e-5);
  const Tensor weights = torch::rand({1, 4, 22}, options).softmax(-1);
  const auto kl = [&](const Tensor& x) { return training::weight_loss(x.log_softmax(-1), weights); };
  EXPECT_LT(gradient_error(kl, torch::randn({1, 4, 22})), 1e-5);
  const Tensor places = torch::randn({2, 3, 3}, options), has = torch::tensor({1.0, 0.0}, options);
  const auto canonical = [&](const Tensor& x) { return training::canonical_loss(x, places, has); };
  EXPECT_LT(gradient_error(canonical, torch::randn({2, 3, 3})), 1e-5);
}

TEST(DeformationLosses, AreZeroAtTheTruth) {
  const Tensor truth = torch::randn({1, 4, 2, 3}), weights = torch::rand({1, 4, 22}).softmax(-1);
  EXPECT_NEAR(training::geometry_loss(truth, truth).item<double>(), 0, 1e-9);
  EXPECT_NEAR(training::edge_loss(truth + 1, truth).item<double>(), 0, 1e-6);  // a shift changes no length
  EXPECT_NEAR(training::weight_loss(weights.log(), weights).item<double>(), 0, 1e-5);
}

TEST(DeformationLosses, GeometryIsTheMeanDistance) {
  const Tensor truth = torch::zeros({1, 2, 1, 3});
  Tensor posed = truth.clone();
  posed[0][0][0][1] = 0.03f;
  EXPECT_NEAR(training::geometry_loss(posed, truth).item<double>(), 0.015, 1e-4);
}

}  // namespace
}  // namespace understudy
