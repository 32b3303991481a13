#include "retarget/style/manner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/style_metrics.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/style/load_style.hpp"
#include "retarget/style/skeleton_style.hpp"

namespace understudy {
namespace {

Manner manner_of(const std::string& name) {
  return read_manner(US_SOURCE_DIR "/assets/styles/" + name + ".json").manner;
}

std::unique_ptr<SkeletonStyle> style_of(const std::string& name, float strength = 1) {
  return std::make_unique<SkeletonStyle>(std::make_unique<MannerStyle>(manner_of(name), 1.0f, 1.0f, 1.0f),
                                         strength);
}

std::vector<Extraction> motion(const std::string& name, float fps = 30, size_t count = 0) {
  const Motion clip = builtin_motion(name, human_rest(), fps);
  std::vector<Extraction> frames;
  for (size_t t = 0; t < (count > 0 ? count : clip.poses.size()); ++t)
    frames.push_back(exact_extraction(forward_kinematics(human_rest(), clip.poses[t % clip.poses.size()])));
  return frames;
}

std::vector<Extraction> styled(MotionStyle& style, const std::vector<Extraction>& source, float fps = 30) {
  style.reset();
  std::vector<Extraction> out;
  for (const Extraction& frame : source) {
    style.push(frame, 1 / fps);
    while (auto next = style.pop()) out.push_back(std::move(*next));
  }
  style.finish();
  while (auto next = style.pop()) out.push_back(std::move(*next));
  return out;
}

JointSequence joints_of(const std::vector<Extraction>& frames) {
  JointSequence joints;
  for (const Extraction& frame : frames) joints.push_back(frame.joints);
  return joints;
}

TEST(MannerStyle, GivesAnExactFrameForEachAtOnce) {
  const auto style = style_of("child");
  EXPECT_EQ(style->lag_s(), 0);
  const auto source = motion("walk");
  for (const Extraction& frame : source) {
    style->push(frame, 1 / 30.0f);
    const auto out = style->pop();
    ASSERT_TRUE(out);
    EXPECT_TRUE(out->exact && out->global);
    EXPECT_FALSE(style->pop());
    const auto was = bone_lengths(frame.joints), is = bone_lengths(out->joints);
    EXPECT_TRUE((was - is).abs().maxCoeff() < 1e-4f);
  }
}

TEST(MannerStyle, LooksOnlyBack) {
  const auto style = style_of("child");
  const auto source = motion("dance");
  const auto whole = styled(*style, source);
  const std::vector<Extraction> first(source.begin(), source.begin() + 40);
  const auto part = styled(*style, first);
  ASSERT_EQ(part.size(), 40u);
  for (size_t t = 0; t < part.size(); ++t) EXPECT_EQ(part[t].joints, whole[t].joints) << t;
}

TEST(MannerStyle, TurningOrMovingTheSourceTurnsOrMovesTheResult) {
  const Mat3 turn = rotation_about_y(2.1f);
  const Vec3 by(3, 0, -7);
  auto source = motion("dance");
  const auto style = style_of("child");
  const auto plain = styled(*style, source);
  for (Extraction& frame : source) {
    frame.joints = (frame.joints * turn.transpose()).rowwise() + by.transpose();
    for (Mat3& R : *frame.global) R = turn * R;
  }
  const auto moved = styled(*style, source);
  for (size_t t = 0; t < plain.size(); ++t) {
    const Joints expected = (plain[t].joints * turn.transpose()).rowwise() + by.transpose();
    EXPECT_LT((moved[t].joints - expected).rowwise().norm().maxCoeff(), 2e-3f) << t;
  }
}

TEST(MannerStyle, WhoStandsStillStandsStill) {
  const std::vector<Extraction> still(90, motion("walk", 30, 1)[0]);
  for (const char* const name : {"child", "old", "tired", "happy"}) {
    const auto style = style_of(name);
    const auto out = styled(*style, still);
    for (size_t t = 31; t < out.size(); ++t)
      EXPECT_LT((out[t].joints - out[30].joints).rowwise().norm().maxCoeff(), 1e-3f) << name << t;
  }
}

TEST(MannerStyle, StandingFeetStand) {
  const auto source = motion("walk", 30, 240);
  const double before = stance_slide(joints_of(source), 30);
  for (const char* const name : {"child", "old", "tired", "happy"}) {
    const auto style = style_of(name);
    const auto out = joints_of(styled(*style, source));
    EXPECT_LT(stance_slide(out, 30), std::max(1.5 * before, 0.06)) << name << ", source " << before;
    double lowest = 1e9, lowest_source = 1e9;
    for (size_t t = 30; t < out.size(); ++t)
      for (const int j : {LeftFoot, RightFoot}) {
        lowest = std::min(lowest, static_cast<double>(out[t](j, 1)));
        lowest_source = std::min(lowest_source, static_cast<double>(source[t].joints(j, 1)));
      }
    EXPECT_NEAR(lowest, lowest_source, 0.03) << name;
  }
}

/// Legs that are turned by the style, the left unlike the right, arms untouched.
std::unique_ptr<SkeletonStyle> turned_legs() {
  Coupling coupling;
  coupling.joints = {LeftHip, RightHip, LeftKnee, RightKnee};
  coupling.gains = 1.4f * Eigen::MatrixXf::Identity(12, 12);
  for (int k = 0; k < 3; ++k) coupling.gains(k, k) = 0.8f;
  coupling.offsets[RightHip] = Vec3(-0.1f, 0, 0.05f);
  Manner manner;
  manner.coupling = coupling;
  return std::make_unique<SkeletonStyle>(std::make_unique<MannerStyle>(manner, 1.0f, 1.0f, 1.0f), 1.0f);
}

TEST(MannerStyle, FeetStandOnLegsThatTheStyleTurns) {
  for (const char* const name : {"walk", "dance"}) {
    const auto source = motion(name);
    const double before = stance_slide(joints_of(source), 30);
    const auto style = turned_legs();
    const auto out = joints_of(styled(*style, source));
    EXPECT_LT(stance_slide(out, 30), std::max(1.2 * before, 0.02)) << name << ", source " << before;
    double changed = 0;
    for (size_t t = 0; t < out.size(); ++t)
      changed = std::max(changed,
                         static_cast<double>((out[t].row(LeftKnee) - out[t].row(Pelvis) -
                                              source[t].joints.row(LeftKnee) + source[t].joints.row(Pelvis))
                                                 .norm()));
    EXPECT_GT(changed, 0.03) << name;
  }
}

TEST(MannerStyle, AChildSwaysMoreAndTurnsTheHeadMore) {
  const auto source = motion("dance");
  const auto style = style_of("child");
  const auto out = styled(*style, source);
  EXPECT_GT(body_sway_deg(joints_of(out), 30), 1.2 * body_sway_deg(joints_of(source), 30));
  EXPECT_GT(pelvis_speed_legs(joints_of(out), 30), 1.2 * pelvis_speed_legs(joints_of(source), 30));
}

TEST(MannerStyle, WhoLiesIsLeftAsTheyLie) {
  auto source = motion("walk", 30, 60);
  const Mat3 down = Eigen::AngleAxisf(-kPi / 2, Vec3::UnitX()).toRotationMatrix();
  for (Extraction& frame : source) {
    frame.joints = frame.joints * down.transpose();
    for (Mat3& R : *frame.global) R = down * R;
  }
  const auto style = style_of("old");
  const auto out = styled(*style, source);
  for (size_t t = 0; t < out.size(); ++t)
    for (int j = 0; j < kJointCount; ++j)
      EXPECT_LT(geodesic_angle((*out[t].global)[j], (*source[t].global)[j]), 0.01f) << t << " " << j;
}

TEST(MannerStyle, TheRateOfTheSourceHardlyMatters) {
  const auto style = style_of("child");
  const auto slow = styled(*style, motion("walk", 12), 12), fast = styled(*style, motion("walk", 240), 240);
  ASSERT_GT(slow.size(), 20u);
  double worst = 0;
  for (size_t t = 12; t < slow.size() && 20 * t < fast.size(); ++t)
    for (const int j : {Spine3, Head, LeftShoulder, RightElbow})
      worst = std::max(worst,
                       static_cast<double>(geodesic_angle((*slow[t].global)[j], (*fast[20 * t].global)[j])));
  EXPECT_LT(worst * 180 / kPi, 12);
}

TEST(MannerStyle, PathsOfTenThousandFramesKeepTheirScale) {
  const auto cycle = motion("walk");
  const auto style = style_of("old");
  double first = 0, last = 0;
  Joints before = Joints::Zero();
  Vec3 ahead = Vec3::Zero();  // the clip again and again, each time from where it ended
  const Vec3 way = (cycle.back().joints.row(Pelvis) - cycle.front().joints.row(Pelvis)).transpose();
  for (size_t t = 0; t < 10000; ++t) {
    Extraction frame = cycle[t % cycle.size()];
    if (t > 0 && t % cycle.size() == 0) ahead += Vec3(way.x(), 0, way.z());
    frame.joints.rowwise() += ahead.transpose();
    style->push(frame, 1 / 30.0f);
    const Joints now = style->pop()->joints;
    ASSERT_TRUE(now.allFinite());
    const double step = t > 0 ? static_cast<double>((now.row(Pelvis) - before.row(Pelvis)).norm()) : 0;
    (t < 5000 ? first : last) += step;
    before = now;
  }
  EXPECT_NEAR(last / first, 1, 0.02);
}

TEST(MannerStyle, GoesOnAfterAGapOfMinutes) {
  const auto source = motion("dance", 30, 20);
  for (const char* const name : {"child", "old", "tired", "happy"}) {
    const auto style = style_of(name);
    for (size_t t = 0; t < source.size(); ++t) {
      style->push(source[t], t == 10 ? 180.0f : 1 / 30.0f);
      const auto out = style->pop();
      ASSERT_TRUE(out);
      EXPECT_TRUE(out->joints.allFinite()) << name << t;
      EXPECT_LT((out->joints - source[t].joints).rowwise().norm().maxCoeff(), 1) << name << t;
    }
  }
}

TEST(MannerStyle, WhoClimbsKeepsLegsAndHeight) {
  auto source = motion("walk", 30, 300);
  for (size_t t = 0; t < source.size(); ++t)
    source[t].joints.col(1).array() += 0.3f * static_cast<float>(t) / 30;  // 3 m of stairs in ten seconds
  for (const char* const name : {"child", "tired"}) {
    const auto style = style_of(name);
    const auto out = styled(*style, source);
    for (size_t t = 30; t < out.size(); ++t) {
      EXPECT_NEAR(out[t].joints(Pelvis, 1), source[t].joints(Pelvis, 1), 0.2f) << name << t;
      const float reach = (out[t].joints.row(LeftAnkle) - out[t].joints.row(LeftHip)).norm();
      EXPECT_GT(reach, 0.5f * leg_length(source[t].joints)) << name << t;
    }
  }
}

TEST(MannerStyle, ASkeletonWithoutLegsIsRefused) {
  const auto style = style_of("child");
  Extraction none;
  EXPECT_THROW(style->push(none, 1 / 30.0f), Error);
  none.joints.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(style->push(none, 1 / 30.0f), Error);
}

TEST(Strength, HalfOfItIsHalfTheWay) {
  const auto source = motion("walk", 30, 40);
  const auto whole_style = style_of("old"), half_style = style_of("old", 0.5f),
             more_style = style_of("old", 1.5f);
  const auto whole = styled(*whole_style, source), half = styled(*half_style, source),
             more = styled(*more_style, source);
  const auto turned = [&](const std::vector<Extraction>& out, size_t t, int j) {
    return geodesic_angle(local_rotations(*source[t].global)[j], local_rotations(*out[t].global)[j]);
  };
  for (const size_t t : {10u, 30u})
    for (const int j : {Spine1, Head, LeftShoulder}) {
      EXPECT_NEAR(turned(half, t, j), 0.5f * turned(whole, t, j), 0.01f) << j;
      EXPECT_NEAR(turned(more, t, j), 1.5f * turned(whole, t, j), 0.01f) << j;
    }
}

StyleChoice named(const std::string& word) {
  StyleChoice choice;
  choice.choose(word);
  return choice;
}

TEST(LoadStyle, NothingIsLoadedWhereNothingIsToBeChanged) {
  EXPECT_EQ(load_style({}), nullptr);
  StyleChoice none = named("child");
  none.strength = 0;
  EXPECT_EQ(load_style(none), nullptr);
}

TEST(LoadStyle, AnUnknownNameIsRefused) {
  EXPECT_NE(failure_of([] { load_style(named("chld")); }).find("there is no style 'chld'"),
            std::string::npos);
  EXPECT_NE(
      failure_of([] { load_style(named("/no/such.json")); }).find("/no/such.json: there is no such file"),
      std::string::npos);
}

}  // namespace
}  // namespace understudy
