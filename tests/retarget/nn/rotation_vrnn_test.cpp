// The dynamics of paper 3: its equations on numbers worked out by hand, its training, and what a file holds.
#include "retarget/nn/modules/rotation_vrnn.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/marionette/dynamics_rows.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/dynamics_step.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace training;

nn::VrnnOptions small(int64_t joints, bool positions = false) {
  nn::VrnnOptions options;
  options.joints = joints, options.positions = positions;
  options.latent = 4, options.hidden = 8, options.inner = 6, options.ahead = 5;
  return options;
}

TEST(RotationVrnn, ForwardKinematicsOfAnyTreeIsEquation2) {
  // A root at the origin turned by 90 degrees about z, a child 1 along x turned by 90 more, its child 2
  // along x.
  const auto quarter = torch::tensor({{0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}});
  const auto rest = torch::tensor({{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}}});
  const auto local = torch::stack({quarter, quarter, torch::eye(3)}).view({1, 1, 3, 3, 3});
  const auto joints = nn::forward_kinematics(rest, local, {-1, 0, 1}).joints;
  EXPECT_TRUE(torch::allclose(joints[0][0][1], torch::tensor({0.0f, 1.0f, 0.0f}), 0, 1e-6));
  EXPECT_TRUE(torch::allclose(joints[0][0][2], torch::tensor({-2.0f, 1.0f, 0.0f}), 0, 1e-6));
}

TEST(RotationVrnn, SquaredErrorIsEquation3) {
  const auto x = torch::zeros({1, 2, 1, 3});
  auto again = x.clone();
  again[0][0][0][0] = 2;  // 4 in the first frame, 1 in the second
  again[0][1][0][2] = 1;
  const auto off = nn::squared_error(x.squeeze(0), again.squeeze(0));
  EXPECT_EQ(off[0].item<float>(), 4);
  EXPECT_EQ(off[1].item<float>(), 1);
}

TEST(RotationVrnn, DivergenceIsEquation4) {
  // KL(N(1, 2) || N(0, 1)) = (4 + 1 - 1 - ln 4) / 2, and of equal ones 0.
  const auto number = [](float v) { return torch::full({1, 1}, v); };
  EXPECT_NEAR(nn::divergence({number(1), number(2)}, {number(0), number(1)}).item<float>(),
              (4 - std::log(4.0f)) / 2, 1e-6);
  EXPECT_NEAR(nn::divergence({number(3), number(2)}, {number(3), number(2)}).item<float>(), 0, 1e-6);
}

TEST(RotationVrnn, ErrorsOfTurnsAreSummedOverJoints) {
  const auto rotation = [](float angle) {
    const Mat3 R = rotation_from_axis_angle({0, angle, 0}).transpose();  // row by row
    return torch::from_blob(const_cast<float*>(R.data()), {3, 3}).clone();
  };
  const auto still = torch::stack({rotation(0), rotation(0)}).unsqueeze(0);
  const auto turned = torch::stack({rotation(0.5f), rotation(1)}).unsqueeze(0);
  EXPECT_NEAR(turn_error(still, turned).item<float>(),
              2 * std::sqrt(2.0f) * (std::sin(0.25f) + std::sin(0.5f)), 1e-3);
}

TEST(RotationVrnn, TheRootAndTheRotationsComeFromDecodersOfTheirOwn) {  // eq. 18 and 19
  torch::manual_seed(1);
  nn::RotationVrnn net(small(3));
  const nn::VrnnState state = net->begin(1, torch::kCPU);
  const nn::AheadStep nothing = net->nothing_ahead(1, torch::kCPU);
  const auto z = torch::randn({1, 4}), dt = torch::full({1, 1}, 1.0 / 30);
  const auto before = net->decoded(z, state, nothing, dt);
  const torch::NoGradGuard no_grad;
  for (auto& named : net->named_parameters())
    if (named.key().rfind("phi_g", 0) == 0) named.value().add_(0.1);
  const auto after = net->decoded(z, state, nothing, dt);
  EXPECT_FALSE(torch::allclose(before.slice(-1, 0, 4), after.slice(-1, 0, 4)));
  EXPECT_TRUE(torch::equal(before.slice(-1, 4), after.slice(-1, 4)));
  const auto turns = nn::row_turns(after)[0];
  EXPECT_TRUE(torch::allclose(torch::matmul(turns.transpose(-1, -2), turns), torch::eye(3).expand({3, 3, 3}),
                              0, 1e-5));
}

TEST(RotationVrnn, AWayIsWhereTheRowsGoAndBack) {
  // One size a second along its own heading, which turns by 90 degrees from the first frame to the second.
  auto rows = torch::zeros({1, 3, 10});
  const float quarter = kPi / 2;
  rows[0][1][1] = 1, rows[0][1][2] = quarter, rows[0][2][1] = 1, rows[0][2][3] = 0.5f;
  const auto dt = torch::ones({1, 3});
  const auto way = nn::way_of(rows, dt);
  EXPECT_NEAR(way[0][2][2].item<float>(), quarter, 1e-6);
  const Vec3 wanted = Vec3(0, 0, 1) + rotation_about_y(quarter) * Vec3(0, 0, 1);
  EXPECT_NEAR(way[0][2][0].item<float>(), wanted.x(), 1e-6);
  EXPECT_NEAR(way[0][2][1].item<float>(), wanted.z(), 1e-6);
  EXPECT_NEAR(way[0][2][3].item<float>(), 0.5, 1e-6);
  EXPECT_TRUE(torch::allclose(nn::rows_of(way, dt), rows, 0, 1e-6));
}

torch::Tensor known_of(const std::vector<int>& keys, int64_t frames) {
  auto known = torch::zeros({1, frames}, torch::kBool);
  for (const int key : keys) known[0][key] = true;
  return known;
}

TEST(KeyCurve, GoesThroughKeysAsAParabolaDoes) {
  const auto t = torch::arange(9, torch::kFloat32);
  const auto square = (t * t).view({1, 9, 1});
  const nn::KeyCurve curve = nn::curve_through(square, known_of({0, 1, 4, 8}, 9));
  // A parabola is met between two keys that have others beside them; at the ends it bends no more.
  EXPECT_TRUE(torch::allclose(curve.way.slice(1, 1, 5), square.slice(1, 1, 5), 0, 1e-4));
  EXPECT_NEAR(curve.way[0][8][0].item<float>() - curve.way[0][7][0].item<float>(), 14, 1.5);
  EXPECT_EQ(curve.left[0][1][0].item<float>(), 0);
  EXPECT_EQ(curve.left[0][2][0].item<float>(), 2);
  const nn::KeyCurve straight = nn::curve_through(square, known_of({0, 4}, 9));
  EXPECT_NEAR(straight.way[0][1][0].item<float>(), 4, 1e-5);
  EXPECT_EQ(straight.left[0][5][0].item<float>(), -1);
  EXPECT_THROW(nn::curve_through(square, known_of({1, 4}, 9)), Error);
}

TEST(RotationVrnn, InAKeyItIsTheKeyAndWithoutOneItGoesOn) {
  torch::manual_seed(4);
  for (const bool positions : {false, true}) {
    const torch::NoGradGuard no_grad;
    nn::RotationVrnn net(small(2, positions));
    for (auto& parameter : net->parameters()) parameter.normal_(0, 0.5);
    const auto dt = torch::full({1, 7}, 1.0 / 30), step = dt.slice(1, 0, 1);
    nn::VrnnState state = net->begin(1, torch::kCPU);
    auto way = torch::zeros({1, 7, net->width()});
    way[0][0].slice(0, 4) = state.last[0].slice(0, 4);
    way[0][4] = way[0][0];
    way[0][4][0] = 0.3f, way[0][4][1] = -0.2f, way[0][4][2] = 0.7f, way[0][4][3] = 0.5f;
    const nn::Ahead ahead = net->ahead(way, known_of({0, 4}, 7), dt);
    std::vector<torch::Tensor> rows = {state.last};
    for (int64_t t = 1; t < 7; ++t) {
      const nn::AheadStep to = nn::step_of(ahead, t);
      rows.push_back(net->decoded(net->prior(state, to, step).mean, state, to, step));
      net->advance(rows.back(), torch::zeros({1, 4}), step, state);
    }
    const auto gone = nn::way_of(torch::stack(rows, 1), dt);
    EXPECT_TRUE(torch::allclose(gone[0][4], way[0][4], 0, 1e-4)) << positions;
    EXPECT_FALSE(torch::allclose(gone[0][2], way[0][2], 0, 1e-2)) << positions;  // not the curve alone
    EXPECT_FALSE(torch::allclose(gone[0][6], gone[0][4], 0, 1e-2)) << positions;
  }
}

TEST(DynamicsStep, PlacesStandWhereTheRootIs) {
  const auto way = torch::tensor({{{1.0f, 2.0f, static_cast<float>(kPi / 2), 3.0f}}});
  const auto places = torch::tensor({{{{0.0f, 1.0f, 1.0f}}}});  // one ahead, and one up
  EXPECT_TRUE(torch::allclose(world_places(way, places), torch::tensor({{{{2.0f, 4.0f, 2.0f}}}}), 0, 1e-5));
}

TEST(DynamicsStep, AJointThatStandsCountsMoreWhenItSlides) {
  const auto still = torch::zeros({1, 1, 1, 3});
  auto fast = still.clone(), off = still.clone();
  fast[0][0][0][0] = 2, off[0][0][0][2] = 0.5f;
  EXPECT_NEAR(velocity_error(fast, fast + off).item<float>(), 0.5, 1e-3);
  EXPECT_GT(velocity_error(still, off).item<float>(), 1);
}

TEST(DynamicsData, WhatIsKnownOfASequence) {
  DynamicsData data("hand", "", Split::Dev);
  Rng rng(1);
  const DynamicsBatch keys = data.batch(12, 40, Known::Keys, rng),
                      beginning = data.batch(12, 40, Known::Beginning, rng);
  for (int64_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(keys.known[i][0].item<bool>() && keys.known[i][39].item<bool>());
    EXPECT_TRUE(beginning.known[i][1].item<bool>());
    EXPECT_FALSE(beginning.known[i][10].item<bool>());
    int64_t last = 0;
    for (int64_t t = 1; t < 40; ++t)
      if (keys.known[i][t].item<bool>()) {
        EXPECT_LT(static_cast<float>(t - last) * keys.dt[i][0].item<float>(), 1.06f);
        last = t;
      }
  }
}

TEST(RotationVrnn, TheLossFallsWhenOneBatchIsLearned) {
  torch::manual_seed(2);
  DynamicsData data("hand", "", Split::Dev);
  Rng rng(1);
  for (const Known known : {Known::Keys, Known::Beginning}) {
    const DynamicsBatch batch = data.batch(4, 20, known, rng);
    for (const bool positions : {false, true}) {
      nn::VrnnOptions options;
      options.joints = static_cast<int64_t>(data.parents().size());
      options.positions = positions;
      nn::RotationVrnn net(options);
      torch::optim::Adam optimizer(net->parameters(), torch::optim::AdamOptions(2e-3));
      double first = 0, last = 0;
      for (int i = 0; i < 60; ++i) {
        optimizer.zero_grad();
        const LossSum loss = dynamics_loss(net, batch, data.parents());
        loss.total.backward();
        optimizer.step();
        last = loss.total.item<double>();
        if (i == 0) first = last;
      }
      EXPECT_LT(last, first / 2) << positions << " " << static_cast<int>(known);
    }
  }
}

class DynamicsFile : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
    rig_ = make_creature(CreatureKind::Hand, 3);
    motion_ = creature_motion(CreatureKind::Hand, rig_, 0, 20, 30, 3);
  }
  void TearDown() override { log::set_sink(before_); }
  /// With random weights.
  std::string file(const std::string& form) {
    torch::manual_seed(3);
    nn::VrnnOptions options;
    options.joints = rig_.count();
    options.positions = form == "positions";
    const nn::RotationVrnn net(options);
    const std::string path = folder_.path() + "/" + form + ".weights";
    nn::save_weights(
        path,
        {nn::kDynamicsWeights,
         nn::kDynamicsVersion,
         {{"joints", static_cast<double>(options.joints)}, {"positions", options.positions ? 1.0 : 0.0}},
         {{"kind", "hand"}, {"bones", bones_of(rig_)}}},
        *net);
    return path;
  }

  testing::DataFolder folder_;
  Rig rig_;
  RigMotion motion_;
  log::Sink before_;
};

TEST_F(DynamicsFile, GoesOnFromPosesTheSameForTheSameSeedAndAClonesOwnWay) {
  for (const char* form : {"rotations", "positions"}) {
    const auto dynamics = nn::load_dynamics(file(form));
    EXPECT_EQ(dynamics->kind(), "hand");
    dynamics->begin(rig_);
    Rng rng(1);
    EXPECT_THROW(dynamics->sample(1.0 / 30, rng), Error);
    for (int t = 0; t < 5; ++t) dynamics->observe(motion_.poses[static_cast<size_t>(t)], 1.0 / 30);
    const auto other = dynamics->clone();
    Rng same(1), different(2);
    rng = Rng(1);
    const RigPose a = dynamics->sample(1.0 / 30, rng), b = other->clone()->sample(1.0 / 30, same),
                  c = other->sample(1.0 / 30, different);
    EXPECT_EQ((a.turns[3] - b.turns[3]).norm(), 0);
    EXPECT_GT((a.turns[3] - c.turns[3]).norm(), 0);
    for (size_t j = 1; j < rig_.joints.size(); ++j)
      if (rig_.joints[j].kind == JointKind::Hinge)
        EXPECT_LT((a.turns[j] * rig_.joints[j].axis - rig_.joints[j].axis).norm(), 1e-4f);
  }
}

TEST_F(DynamicsFile, KeysAreMetToTheLastBitAndTheSameSeedGoesTheSameWay) {
  for (const char* form : {"rotations", "positions"}) {
    const auto dynamics = nn::load_dynamics(file(form));
    dynamics->begin(rig_);
    const std::vector<PoseKey> keys = {
        {0, motion_.poses[0]}, {12, motion_.poses[12]}, {15, motion_.poses[15]}};
    const auto way = [&](uint64_t seed, double dt) {
      Rng rng(seed);
      return dynamics->aimed(keys, dt, rng);
    };
    const auto made = way(1, 1.0 / 30), again = way(1, 1.0 / 30), other = way(2, 1.0 / 30),
               slower = way(1, 1.0 / 10);
    ASSERT_EQ(made.size(), 16u);
    for (const PoseKey& key : keys)
      EXPECT_EQ((made[static_cast<size_t>(key.frame)].turns[3] - key.pose.turns[3]).norm(), 0) << form;
    const auto apart = [](const std::vector<RigPose>& a, const std::vector<RigPose>& b) {
      float sum = 0;
      for (size_t t = 0; t < a.size(); ++t)
        for (size_t j = 0; j < a[t].turns.size(); ++j) sum += (a[t].turns[j] - b[t].turns[j]).norm();
      return sum;
    };
    EXPECT_EQ(apart(made, again), 0) << form;
    EXPECT_GT(apart(made, other), 0) << form;
    EXPECT_GT(apart(made, slower), 0) << form;  // it is told how long a frame is
    Rng rng(1);
    dynamics->sample(1.0 / 30, rng);  // it may go on from the last key
    EXPECT_THROW(dynamics->aimed({keys[1], keys[2]}, 1.0 / 30, rng), Error);
  }
}

TEST_F(DynamicsFile, WhatIsRaisedGoesOnFromThere) {
  const auto dynamics = nn::load_dynamics(file("rotations"));
  dynamics->begin(rig_);
  EXPECT_THROW(dynamics->raise(0.1f), Error);
  dynamics->observe(motion_.poses[0], 1.0 / 30);
  const auto other = dynamics->clone();
  other->raise(0.1f);
  Rng a(1), b(1);
  EXPECT_NEAR(other->sample(1.0 / 30, b).root.y() - dynamics->sample(1.0 / 30, a).root.y(), 0.1, 1e-4);
}

TEST_F(DynamicsFile, WeightsOfAnotherFormAreRefused) {
  torch::manual_seed(3);
  nn::VrnnOptions options;
  options.joints = rig_.count();
  const std::string path = folder_.path() + "/old.weights";
  nn::save_weights(path,
                   {nn::kDynamicsWeights,
                    1,
                    {{"joints", static_cast<double>(options.joints)}},
                    {{"kind", "hand"}, {"bones", bones_of(rig_)}}},
                   *nn::RotationVrnn(options));
  try {
    nn::load_dynamics(path);
    FAIL() << "weights of version 1 were taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("old.weights: weights of version 1"), std::string::npos) << e.what();
  }
}

TEST_F(DynamicsFile, ARigOfOtherBonesAndAFolderWithoutWeightsAreRefused) {
  const std::string path = file("rotations");
  const auto dynamics = nn::load_dynamics(path);
  EXPECT_THROW(dynamics->begin(make_creature(CreatureKind::Arm, 1)), Error);
  EXPECT_THROW(nn::load_dynamics(folder_.path() + "/none.weights"), Error);
  EXPECT_THROW(nn::load_motion_dynamics(folder_.path(), rig_), Error);
}

TEST_F(DynamicsFile, RowsSayPosesAndPosesRows) {
  const DynamicsRows rows(rig_);
  for (size_t t = 1; t < motion_.poses.size(); ++t) {
    const RigPose &before = motion_.poses[t - 1], &pose = motion_.poses[t];
    const Eigen::RowVectorXf row = rows.row(before, pose, 1.0 / 30);
    const Points truth = joint_places(rig_, bone_motions(rig_, pose));
    const RigPose again = rows.pose(before, row, 1.0 / 30);
    EXPECT_LT((joint_places(rig_, bone_motions(rig_, again)) - truth).rowwise().norm().maxCoeff(), 1e-4f);
    const RigPose placed = rows.pose_at(before, rows.places_row(pose, row), 1.0 / 30);
    EXPECT_LT((joint_places(rig_, bone_motions(rig_, placed)) - truth).rowwise().norm().maxCoeff(), 3e-3f);
  }
}

}  // namespace
}  // namespace understudy
