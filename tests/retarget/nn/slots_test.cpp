// The network of slots, its losses on hand-worked numbers, and its training.
#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/affinity.hpp"
#include "retarget/nn/modules/slot_net.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/losses/keypoint_losses.hpp"
#include "retarget/training/losses/slot_losses.hpp"
#include "retarget/training/slot_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy {
namespace {

Points some_body() {
  Rng rng(3);
  Points body = training::points_on(make_creature(CreatureKind::Arm, 0), nn::kSlotPoints, rng).rest;
  const Eigen::RowVector3f middle = body.colwise().mean();
  return (body.rowwise() - middle) / 0.4f;
}

nn::SlotOutput seen(nn::SlotNet& net, const Points& points) {
  nn::SlotInput input = nn::empty_slot_input(1);
  nn::put_slot_points(points, 0, input);
  torch::NoGradGuard guard;
  return net->forward(input);
}

torch::Tensor tensor_of_turn(const Mat3& turn) {
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rows = turn;
  return torch::from_blob(const_cast<float*>(rows.data()), {3, 3}).clone();
}

TEST(SlotNet, WhatItSeesTurnsWithTheBody) {
  torch::manual_seed(1);
  nn::SlotNet net(12);
  const Points body = some_body();
  const Mat3 turn = Eigen::AngleAxisf(2.1f, Vec3::UnitY()).toRotationMatrix();
  const nn::SlotOutput before = seen(net, body), after = seen(net, body * turn.transpose());
  const auto turned = tensor_of_turn(turn);
  EXPECT_LT((torch::matmul(before.places, turned.t()) - after.places).abs().max().item<float>(), 1e-3);
  EXPECT_LT((torch::matmul(turned, before.turns) - after.turns).abs().max().item<float>(), 1e-3);
  EXPECT_LT((before.shares - after.shares).abs().max().item<float>(), 1e-3);
  EXPECT_GT((before.places - after.places).abs().max().item<float>(), 0.05) << "it did turn";
}

TEST(SlotNet, SharesSumToOneAndTurnsAreRotations) {
  torch::manual_seed(2);
  nn::SlotNet net(28);
  const nn::SlotOutput out = seen(net, some_body());
  EXPECT_EQ(out.places.sizes(), (std::vector<int64_t>{1, 28, 3}));
  EXPECT_LT((out.shares.sum(2) - 1).abs().max().item<float>(), 1e-5);
  const auto unit = torch::matmul(out.turns, out.turns.transpose(2, 3));
  EXPECT_LT((unit - torch::eye(3)).abs().max().item<float>(), 1e-4);
  EXPECT_THROW(seen(net, some_body().topRows(100)), Error);
}

TEST(SlotNet, AffinitiesHaveRowsOfOneAndNoLoop) {
  const auto rows = nn::affinities_of(torch::tensor({{{0.0f, 0.0f}, {0.0f, std::log(3.0f)}, {1.0f, 1.0f}}}));
  ASSERT_EQ(rows.sizes(), (std::vector<int64_t>{1, 3, 3}));
  const auto wanted = torch::tensor({{0.0f, 0.5f, 0.5f}, {0.25f, 0.0f, 0.75f}, {0.5f, 0.5f, 0.0f}});
  EXPECT_TRUE(torch::allclose(rows[0], wanted));
}

/// One scan of one point, two slots: the first stays, the second turns by 90 degrees about z and goes to x =
/// 2.
struct TwoSlots {
  nn::SlotOutput from, to;
  TwoSlots() {
    from.places = torch::tensor({{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}}});
    to.places = torch::tensor({{{0.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}}});
    from.turns = torch::eye(3).expand({1, 2, 3, 3}).clone();
    to.turns = from.turns.clone();
    to.turns[0][1] = torch::tensor({{0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}});
    from.shares = torch::tensor({{{0.0f, 1.0f}, {0.5f, 0.5f}}});
  }
};

TEST(SlotLosses, APointIsCarriedByTheSlotsThatShareIt) {
  const TwoSlots two;
  const auto moved =
      training::carried(torch::tensor({{{1.5f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}}}), two.from, two.to);
  EXPECT_TRUE(torch::allclose(moved[0][0], torch::tensor({2.0f, 0.5f, 0.0f}), 1e-4, 1e-5));
  EXPECT_TRUE(torch::allclose(moved[0][1], torch::tensor({1.5f, 0.0f, 0.0f}), 1e-4, 1e-5));
}

TEST(SlotLosses, AJointIsWhatBothSlotsCarryAlike) {
  TwoSlots two;
  // The first keypoint hangs on the second, which takes (0, 0, 0) to (2, -1, 0): sqrt 5 from where it is. The
  // second one hangs on the first, which leaves it at (1, 0, 0): 1 from where it is.
  const auto missed = training::missed_by(two.from, two.to);
  EXPECT_NEAR(missed[0][1][0].item<float>(), std::sqrt(5.0f), 1e-3);
  EXPECT_NEAR(missed[0][0][1].item<float>(), 1, 1e-3);
  const auto both = torch::tensor({{0.0f, 1.0f}, {1.0f, 0.0f}});
  EXPECT_NEAR(training::joint_loss(both, missed).item<float>(), (std::sqrt(5.0f) + 1) / 2, 1e-3);
  const auto first = torch::tensor({{0.0f, 0.0f}, {1.0f, 0.0f}});
  EXPECT_NEAR(training::joint_loss(first, missed).item<float>(), std::sqrt(5.0f) / 2, 1e-3);
}

TEST(SlotLosses, WhatIsCarriedBestHangsTogetherMost) {
  const auto costs = torch::tensor({{0.0f, 0.1f, 0.5f}, {0.2f, 0.0f, 0.1f}, {0.5f, 0.1f, 0.0f}});
  const auto affinity = training::affinity_of_links(costs, 0.1);
  EXPECT_TRUE(torch::allclose(affinity.sum(0), torch::ones(3)));
  EXPECT_EQ(affinity.diagonal().abs().max().item<float>(), 0);
  EXPECT_NEAR(affinity[0][1].item<float>(), 0.5, 1e-5) << "both carry it alike";
  EXPECT_NEAR((affinity[1][0] / affinity[2][0]).item<float>(), std::exp(3.0f), 1e-2);
}

TEST(SlotLosses, KeypointsInOnePlaceCrowd) {
  const auto spread = torch::tensor({{{0.0f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f}, {0.0f, 5.0f, 0.0f}}});
  EXPECT_NEAR(training::crowding_loss(spread).item<float>(), 0, 1e-4);
  const auto two = torch::tensor({{{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 5.0f, 0.0f}}});
  EXPECT_NEAR(training::crowding_loss(two, 0.1).item<float>(), 2 * std::exp(-0.5f) / 3, 1e-4);
}

TEST(SlotLosses, KeypointsThatExchangePlacesGoFar) {
  const auto still = torch::tensor({{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}}), swapped = still.flip(0);
  const auto steps = [](const torch::Tensor& a, const torch::Tensor& b) {
    return training::place_steps(torch::stack({a, b}).unsqueeze(0)).item<float>();
  };
  EXPECT_NEAR(steps(still, still), 0.01, 1e-4);
  EXPECT_NEAR(steps(still, swapped), 3, 1e-3);
}

TEST(SlotNet, LinksCostTheMeanOfWhatWasSeen) {
  nn::SlotNet net(3);
  const auto missed = torch::full({3, 3}, 0.2), apart = torch::full({3, 3}, 0.5);
  for (int i = 0; i < 5; ++i) net->learn_links(missed, apart);
  EXPECT_TRUE(torch::allclose(net->link_costs(), torch::full({3, 3}, 0.2 + 0.2 * 0.5), 1e-4, 1e-5))
      << "after a few steps, too";
  for (int i = 0; i < 2000; ++i) net->learn_links(2 * missed, apart);
  EXPECT_TRUE(torch::allclose(net->link_costs(), torch::full({3, 3}, 0.4 + 0.2 * 0.5), 1e-3, 1e-4));
}

TEST(SlotLosses, VolumeIsThePointsSquaredDistanceToTheNearestKeypoint) {  // paper 3, eq. 8
  const auto points = torch::tensor({{{0.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}}});
  const auto places = torch::tensor({{{0.0f, 1.0f, 0.0f}, {5.0f, 0.0f, 0.0f}}});
  EXPECT_NEAR(training::volume_fitting_loss(points, torch::ones({1, 2}), places).item<float>(),
              (1 + 4) / 2.0f, 1e-5);
}

class SlotTraining : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  nn::MarionetteSlotsTrainOptions options() {
    nn::MarionetteSlotsTrainOptions options;
    options.kind = "arm";
    options.out = path("marionette_slots_arm.weights");
    options.samples = 24;
    options.batch = 4;
    return options;
  }
  std::string folder_ = ::testing::TempDir() + "/slots" + std::to_string(::getpid());
};

TEST_F(SlotTraining, WritesWeightsThatFindTheSameKeypointsInEveryScan) {
  ASSERT_EQ(training::train(options()), 0);
  const auto finder = nn::load_slots(options().out);
  EXPECT_EQ(finder->kind(), "arm");
  ASSERT_EQ(finder->parents().size(), 12u);
  EXPECT_EQ(std::count(finder->parents().begin(), finder->parents().end(), -1), 1);
  const Rig arm = make_creature(CreatureKind::Arm, 100);
  Mesh moved = arm.surface;
  moved.vertices.rowwise() += Eigen::RowVector3f(3, 0, 1);
  const std::vector<FoundKeypoints> found = finder->find({arm.surface, {}, moved});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].places.rows(), 12);
  EXPECT_EQ(found[0].owner.size(), static_cast<size_t>(arm.surface.vertices.rows()));
  EXPECT_TRUE(found[1].places == found[0].places) << "an empty scan repeats those before it";
  EXPECT_TRUE(((found[2].places - found[0].places).rowwise() - Eigen::RowVector3f(3, 0, 1)).norm() < 1e-3f);
  EXPECT_THROW(finder->find({Mesh{}}), Error);
  Mesh holes = arm.surface;
  holes.faces.resize(0, 3);
  holes.vertices.topRows(20).setConstant(std::nanf(""));
  EXPECT_TRUE(finder->find({holes})[0].places.allFinite());
}

TEST_F(SlotTraining, ALossThatIsLeftOutPullsNothing) {
  const auto trained = [&](const char* name, const nn::MarionetteLosses& losses) {
    nn::MarionetteSlotsTrainOptions how = options();
    how.out = path(name);
    how.samples = 8;  // two steps, the second of which has a tree; bodies take long to make
    how.losses = losses;
    EXPECT_EQ(training::train(how), 0);
    nn::SlotNet net(12);
    nn::load_weights(how.out, "marionette-slots", nn::kSlotVersion, *net);
    return net->named_parameters()["slot_head.0.weight"].clone();
  };
  nn::MarionetteLosses no_volume, no_trajectory, no_local, no_time;
  no_volume.volume = no_trajectory.trajectory = no_local.local = no_time.time = false;
  const auto all = trained("all.weights", {});
  EXPECT_TRUE(torch::equal(all, trained("again.weights", {}))) << "one seed, one training";
  EXPECT_FALSE(torch::equal(all, trained("no_volume.weights", no_volume)));
  EXPECT_FALSE(torch::equal(all, trained("no_trajectory.weights", no_trajectory)));
  EXPECT_FALSE(torch::equal(all, trained("no_local.weights", no_local)));
  EXPECT_FALSE(torch::equal(all, trained("no_time.weights", no_time)));
}

TEST_F(SlotTraining, RefusesAnotherKindAndOthersWeights) {
  nn::MarionetteSlotsTrainOptions wrong = options();
  wrong.kind = "teapot";
  EXPECT_THROW(training::train(wrong), Error);
  std::ofstream(path("no.weights")) << "nothing";
  EXPECT_THROW(nn::load_slots(path("no.weights")), Error);
  EXPECT_THROW(nn::load_slots(path("missing.weights")), Error);
}

}  // namespace
}  // namespace understudy
