// Engine `paper`: its losses equation by equation, the network with and without LibTorch, its data, its
// training.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/pose_code_net.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pose2d/pose_code.hpp"
#include "retarget/training/losses/pose_code_losses.hpp"
#include "retarget/training/pose_code_data.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using namespace training;

/// Two points, all others where the first is; [1, 15, 2].
torch::Tensor two_points(double x, double y) {
  auto poses = torch::zeros({1, kPaperPoints, 2});
  poses[0][1][0] = x, poses[0][1][1] = y;
  return poses;
}
torch::Tensor of_these_two() {
  return torch::tensor({int64_t{1}, int64_t{0}}).view({1, 2});
}
const torch::Tensor& all_count() {
  static const auto mask = torch::ones({1, kPaperPoints});
  return mask;
}
double link(const torch::Tensor& made, const torch::Tensor& source, int directions = 1) {
  return virtual_link_loss(made, source, all_count(), of_these_two(), link_directions(directions, 0))
      .item<double>();
}

TEST(VirtualLink, KeepsWhatIsNearNear) {  // eq. 4, |p_i - p_j| < sigma
  EXPECT_NEAR(link(two_points(0.3, 0), two_points(0.04, 0)), 0.09, 1e-6);
  EXPECT_NEAR(link(two_points(0.02, 0), two_points(-0.04, 0)), 0.0004, 1e-6);
}

TEST(VirtualLink, KeepsTheOrderWithAMargin) {  // eq. 4, the other two
  EXPECT_NEAR(link(two_points(0.5, 0), two_points(0.2, 0)), 0, 1e-6);
  EXPECT_NEAR(link(two_points(0.03, 0), two_points(0.2, 0)), 0.02, 1e-6);
  EXPECT_NEAR(link(two_points(-0.1, 0), two_points(0.2, 0)), 0.15, 1e-6);
  EXPECT_NEAR(link(two_points(0.1, 0), two_points(-0.2, 0)), 0.15, 1e-6);
}

TEST(VirtualLink, IsTheSumOverDirectionsOfTheMeanOverPairs) {  // eq. 5
  const auto four = link_directions(4, 0);
  EXPECT_TRUE(torch::allclose(
      four,
      torch::tensor({1.0, 0.0, M_SQRT1_2, M_SQRT1_2, 0.0, 1.0, -M_SQRT1_2, M_SQRT1_2}, torch::kFloat)
          .view({4, 2}),
      1e-5, 1e-6));
  const auto made = two_points(-0.3, 0.4), source = two_points(0.3, 0.4);
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    sum += virtual_link_loss(made, source, all_count(), of_these_two(), four.narrow(0, k, 1)).item<double>();
  EXPECT_NEAR(link(made, source, 4), sum, 1e-6);
  EXPECT_EQ(link_pairs(LinkPairs::All).size(0), 105);
  EXPECT_EQ(link_pairs(LinkPairs::Bones).size(0), 14);
  EXPECT_EQ(link_pairs(LinkPairs::BonesAndEnds).size(0), 24);
  // 14 of the 105 pairs join the second point with the others, which lie on the first.
  const auto all = virtual_link_loss(two_points(-0.1, 0), two_points(0.2, 0), all_count(),
                                     link_pairs(LinkPairs::All), link_directions(1, 0));
  EXPECT_NEAR(all.item<double>(), 14 * 0.15 / 105, 1e-6);
}

TEST(VirtualLink, WhatIsMissingDoesNotCount) {
  auto mask = torch::ones({1, kPaperPoints});
  mask[0][1] = 0;
  EXPECT_EQ(
      virtual_link_loss(two_points(-0.1, 0), two_points(0.2, 0), mask, of_these_two(), link_directions(4, 0))
          .item<double>(),
      0);
}

TEST(BoneAngle, IsOneMinusTheCosineOverFourteenBones) {  // eq. 6
  auto source = torch::zeros({1, kPaperPoints, 2}), made = torch::zeros({1, kPaperPoints, 2});
  for (int p = 0; p < kPaperPoints; ++p) {  // points on a line, far from each other
    source[0][p][0] = p, made[0][p][0] = 2 * p;
  }
  EXPECT_NEAR(bone_angle_loss(made, source, all_count()).item<double>(), 0, 1e-5);
  made[0][body25::RightWrist][0] = 2 * body25::RightElbow;  // the forearm points up: a quarter turn
  made[0][body25::RightWrist][1] = 1;
  EXPECT_NEAR(bone_angle_loss(made, source, all_count()).item<double>(), 1.0 / 14, 1e-4);
}

TEST(SamePose, SumsOverCoordinates) {  // eq. 3
  EXPECT_NEAR(same_pose_loss(two_points(0.3, -0.2), two_points(0, 0), all_count()).item<double>(), 0.5, 1e-6);
}

TEST(Hinge, LeavesWhatIsRightByAMargin) {
  const auto scores = torch::tensor({2.0, -2.0, 0.5});
  EXPECT_NEAR(hinge_real(scores).item<double>(), (0 + 3 + 0.5) / 3, 1e-6);
  EXPECT_NEAR(hinge_made(scores).item<double>(), (3 + 0 + 1.5) / 3, 1e-6);
}

class PoseCode : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  nn::Pose2dTrainOptions options(const char* name, int64_t steps) const {
    nn::Pose2dTrainOptions options;
    options.data = folder_.path();
    options.out = file(name);
    options.threads = 1;
    options.batch = 8;
    options.samples = 8 * steps;
    return options;
  }
  testing::DataFolder folder_;
};

TEST_F(PoseCode, TheEngineSaysWhatTheModuleSays) {
  torch::manual_seed(4);
  nn::PoseCodeGenerator net;
  nn::save_weights(file("pose2d.weights"), {"pose2d", nn::kPoseCodeVersion, {}}, *net);
  nn::load_weights(file("pose2d.weights"), "pose2d", nn::kPoseCodeVersion, *net);  // halved numbers
  const auto engine = nn::load_code_transfer(file("pose2d.weights"));
  FlatPose pose = flat_person();
  pose.forget(body25::LeftWrist);
  const Proportions from = lengths_of(flat_person());
  Proportions to = from;
  to.length[flat_bone::LeftThigh] *= 1.5f, to.length[flat_bone::RightThigh] *= 1.5f;
  const FlatPose made = engine->transfer(pose, from, to);

  const auto seen = pose_code_input(pose, stature_of(from.length));
  const auto who = person_code_input(to.length);
  const torch::NoGradGuard no_grad;
  const auto told =
      net(torch::from_blob(const_cast<float*>(seen.data()), {1, kPaperPoints, kPoseCodeInputs}).clone(),
          torch::from_blob(const_cast<float*>(who.data()), {1, kFlatBoneCount}).clone());
  const float unit = kPoseCodeUnit * stature_of(to.length);
  EXPECT_FALSE(made.has(body25::LeftWrist)) << "what is missing there is missing here";
  EXPECT_EQ(made.at(body25::MidHip), pose.at(body25::MidHip));
  for (int p = 0; p < kPaperPoints; ++p) {
    if (p == body25::LeftWrist) continue;
    const auto way = told[0][p] - told[0][int{body25::MidHip}];
    EXPECT_NEAR(made.at(p).x(), pose.at(body25::MidHip).x() + unit * way[0].item<float>(), 0.05f) << p;
    EXPECT_NEAR(made.at(p).y(), pose.at(body25::MidHip).y() - unit * way[1].item<float>(), 0.05f) << p;
  }
  EXPECT_TRUE(made.has(body25::LeftHeel)) << "feet ride along";
  EXPECT_TRUE(engine->transfer(pose, from, to) == made) << "the same again";
  EXPECT_THROW(engine->transfer({}, from, to), Error);
}

TEST_F(PoseCode, NobodysMotionIsAnothersAndHalfOfThePairsAreOfOnePerson) {
  const PoseCodeData data(load_training_data(folder_.path(), Split::Train), 1);
  Rng rng(3);
  const PoseCodeBatch batch = data.batch(16, rng);
  EXPECT_EQ(batch.within, 8);
  EXPECT_TRUE(batch.poses.isfinite().all().item<bool>() && batch.people.isfinite().all().item<bool>());
  EXPECT_LT(batch.whole.abs().max().item<double>(), 2);
  EXPECT_LT(batch.person.max().item<int64_t>(), PoseCodeData::kPeople);
}

TEST_F(PoseCode, TrainingLearnsAndGoesOnWhereItStopped) {
  ASSERT_EQ(train(options("a.weights", 60)), 0);
  const auto header = nn::read_weights_header(file("a.weights"));
  EXPECT_EQ(header.numbers.at("steps"), 60);
  EXPECT_GT(header.numbers.at("oks"), 0);
  ASSERT_EQ(train(options("a.weights", 80)), 0);
  EXPECT_EQ(nn::read_weights_header(file("a.weights")).numbers.at("steps"), 80);
}

TEST_F(PoseCode, AblationsTrainWithOtherLosses) {
  for (const char* const links : {"none", "ranking"}) {
    nn::Pose2dTrainOptions other = options(links, 4);
    other.links = links, other.angles = false, other.pairs = "ends", other.directions = 2,
    other.first_direction = 22.5;
    EXPECT_EQ(train(other), 0) << links;
  }
}

}  // namespace
}  // namespace understudy
