// The engine `paper` behind the pipeline's interface.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/weights_file.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;

class PaperTransfer : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() / ("paper_" + std::to_string(::getpid()) + ".weights"))
                .string();
    torch::manual_seed(1);
    nn::MotionGru net(nn::MotionGruOptions{16, 2});
    nn::save_weights(path_, {"motion", nn::kMotionGruVersion, {{"hidden", 16}, {"layers", 2}}}, *net);
    const auto rest = rest_joints(1);
    rest_ = Eigen::Map<const Joints>(rest.data_ptr<float>());
  }
  void TearDown() override { std::filesystem::remove(path_); }

  Extraction source(int frame) const {
    Pose pose;
    pose.local[LeftElbow] = rotation_from_axis_angle({0, 0.1f * static_cast<float>(frame), 0});
    pose.local[Spine1] = rotation_from_axis_angle({0.03f * static_cast<float>(frame), 0, 0});
    Extraction extraction;
    extraction.joints = forward_kinematics(rest_, pose).joints;
    return extraction;
  }
  static float difference(const Rotations& a, const Rotations& b) {
    float worst = 0;
    for (int j = 0; j < kJointCount; ++j) worst = std::max(worst, geodesic_angle(a[j], b[j]));
    return worst;
  }

  std::string path_;
  Joints rest_;
};

TEST_F(PaperTransfer, GivesRotationsAndForgetsAtReset) {
  auto engine = nn::load_paper_transfer(path_);
  engine->reset(rest_);
  std::vector<Rotations> first, second;
  for (int t = 0; t < 5; ++t) first.push_back(engine->push(source(t), 1.0f / 30));
  engine->reset(rest_);
  for (int t = 0; t < 5; ++t) second.push_back(engine->push(source(t), 1.0f / 30));
  for (int t = 0; t < 5; ++t) EXPECT_EQ(difference(first[t], second[t]), 0) << "frame " << t;
  for (const Mat3& R : first[4])
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-5f);
}

TEST_F(PaperTransfer, ABadFrameIsRefusedAndLeavesNoTrace) {
  auto engine = nn::load_paper_transfer(path_), other = nn::load_paper_transfer(path_);
  engine->reset(rest_);
  other->reset(rest_);
  engine->push(source(0), 1.0f / 30);
  other->push(source(0), 1.0f / 30);
  Extraction bad = source(1);
  bad.joints(LeftKnee, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(engine->push(bad, 1.0f / 30), Error);
  EXPECT_EQ(difference(engine->push(source(2), 1.0f / 30), other->push(source(2), 1.0f / 30)), 0);
}

TEST_F(PaperTransfer, WhatItRemembersIsPutBack) {
  auto engine = nn::load_paper_transfer(path_);
  engine->reset(rest_);
  for (int t = 0; t < 3; ++t) engine->push(source(t), 1.0f / 30);
  const std::any before = engine->memory();
  const Rotations first = engine->push(source(3), 1.0f / 30);
  engine->push(source(9), 1.0f / 30);
  engine->restore(before);
  EXPECT_EQ(difference(engine->push(source(3), 1.0f / 30), first), 0);
}

TEST_F(PaperTransfer, TurnsWithTheSource) {
  auto engine = nn::load_paper_transfer(path_);
  engine->reset(rest_);
  const Rotations straight = engine->push(source(3), 1.0f / 30);
  const Mat3 yaw = rotation_about_y(2.5f);
  Extraction turned = source(3);
  turned.joints = (turned.joints * yaw.transpose()).eval();
  engine->reset(rest_);
  const Rotations result = engine->push(turned, 1.0f / 30);
  EXPECT_LT(geodesic_angle(yaw * straight[Pelvis], result[Pelvis]), 1e-3f);
  EXPECT_LT(geodesic_angle(straight[LeftElbow], result[LeftElbow]), 1e-3f);
}

TEST_F(PaperTransfer, WantsATargetAndItsOwnWeights) {
  auto engine = nn::load_paper_transfer(path_);
  EXPECT_THROW(engine->push(source(0), 1.0f / 30), Error);
  EXPECT_THROW(engine->reset(Joints::Zero()), Error);
  EXPECT_THROW(nn::load_paper_transfer(path_ + ".absent"), Error);

  nn::MotionGru net(nn::MotionGruOptions{16, 2});
  nn::save_weights(path_, {"motion", nn::kMotionGruVersion + 1, {{"hidden", 16}, {"layers", 2}}}, *net);
  EXPECT_THROW(nn::load_paper_transfer(path_), Error);
  nn::save_weights(path_, {"motion", nn::kMotionGruVersion, {{"hidden", 1e9}, {"layers", 2}}}, *net);
  EXPECT_THROW(nn::load_paper_transfer(path_), Error);
}

TEST_F(PaperTransfer, ANetworkThatGivesNaNIsAnError) {
  nn::MotionGru net(nn::MotionGruOptions{16, 2});
  {
    const torch::NoGradGuard no_grad;
    net->parameters()[0].fill_(std::numeric_limits<float>::quiet_NaN());
  }
  nn::save_weights(path_, {"motion", nn::kMotionGruVersion, {{"hidden", 16}, {"layers", 2}}}, *net);
  auto engine = nn::load_paper_transfer(path_);
  engine->reset(rest_);
  EXPECT_THROW(engine->push(source(0), 1.0f / 30), Error);
}

}  // namespace
}  // namespace understudy
