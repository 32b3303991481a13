// What holds of every engine of 2D poses, with the shipped weights.
#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/flat_retargeter.hpp"

namespace understudy {
namespace {

nn::NetworkOptions shipped_weights() {
  nn::NetworkOptions options;
  options.weights = US_SOURCE_DIR "/assets/weights";
  return options;
}

/// Somebody walks on the spot, seen from half the side: the same again and again.
struct WalkOnSpot {
  std::vector<FlatPose> poses;  // one period
  Proportions lengths;
};

const WalkOnSpot& walk_on_spot() {
  static const WalkOnSpot made = [] {
    const ShapedBody body = builtin_person();
    const FlatPerson person =
        flat_person(body.vertices, body.joints, head_vertices(body.vertices, body.joints));
    const Motion motion = builtin_motion("walk", body.joints);
    Pinhole camera = looking_at(Vec3(0, 0.9f, 0), camera_axes(0.6f, 0.1f), 6);
    camera.focal = 1200, camera.centre = {360, 360};
    WalkOnSpot walk;
    for (int t = 0; t < 40; ++t) {  // there and back, so that the end meets the beginning
      const auto frame = static_cast<size_t>(t < 20 ? t : 40 - t);
      Pose pose = motion.poses[frame % motion.poses.size()];
      pose.root.x() = pose.root.z() = 0;
      const FlatSight sight = seen_flat(person, pose, camera);
      walk.poses.push_back(sight.pose);
      walk.lengths.length = sight.length;
    }
    return walk;
  }();
  return made;
}

FlatTarget short_legs() {
  FlatTarget made;
  BoneLengths scale = BoneLengths::Ones();
  scale[flat_bone::LeftThigh] = scale[flat_bone::RightThigh] = 0.7f;
  scale[flat_bone::LeftForearm] = scale[flat_bone::RightForearm] = 1.3f;
  made.lengths.length = 0.8f * scale * walk_on_spot().lengths.length;
  made.standing = walk_on_spot().poses.front();
  return made;
}

class FlatEngines : public ::testing::TestWithParam<std::string> {
 protected:
  /// Performs so many frames of the walk; `pose_of` gives what is seen in each.
  template <class PoseOf>
  std::vector<FlatPose> perform(size_t frames, const PoseOf& pose_of) const {
    FlatRetargeter retargeter(nn::load_keypoint_transfer(shipped_weights(), {GetParam(), true, 30}),
                              short_legs(), FlatPlace::Reference);
    KeypointFilter filter;
    std::vector<FlatPose> made;
    for (size_t t = 0; t < frames; ++t) {
      const FlatPose pose = pose_of(t);
      made.push_back(retargeter.push(filter.push(&pose, 1.0 / 30), walk_on_spot().lengths));
    }
    return made;
  }
  static FlatPose walking(size_t t) { return walk_on_spot().poses[t % walk_on_spot().poses.size()]; }
};

float farthest_apart(const FlatPose& a, const FlatPose& b) {
  float far = 0;
  for (int p = 0; p < kBodyPoints; ++p)
    far = std::max(far, a.has(p) != b.has(p) ? 1e6f : a.has(p) ? (a.at(p) - b.at(p)).norm() : 0);
  return far;
}

TEST_P(FlatEngines, NoPoseDependsOnALaterFrame) {
  const auto whole = perform(90, walking);
  const auto other =
      perform(90, [](size_t t) { return t < 60 ? walking(t) : FlatPose(in_mirror(walking(t))); });
  for (size_t t = 0; t < 60; ++t) EXPECT_EQ(whole[t], other[t]) << t;
  EXPECT_GT(farthest_apart(whole[75], other[75]), 1);
}

TEST_P(FlatEngines, TheSameInputGivesTheSameNumbers) {
  EXPECT_EQ(perform(60, walking), perform(60, walking));
}

TEST_P(FlatEngines, TenThousandFramesEndAsTheyBegan) {
  const auto made = perform(10000, walking);
  const size_t period = walk_on_spot().poses.size();
  const auto change_since = [&](size_t earlier) {
    float most = 0;
    for (size_t t = 0; t < period; ++t)
      most = std::max(most, farthest_apart(made[10000 - period + t], made[earlier * period + t]));
    return most;
  };
  const size_t last = 10000 / period - 1;
  EXPECT_LT(change_since(last - 1), 0.02f);  // pixels: nothing drifts by now
  // The memory of `lift` goes on settling for minutes: what it shows of the same walk moves by so much.
  const bool remembers = GetParam() == "lift";
  EXPECT_LT(change_since(10), remembers ? 0.02f * stature_of(short_legs().lengths.length) : 0.01f);
}

TEST_P(FlatEngines, WhatIsMissingMakesNothingThatIsNotFinite) {
  const auto made = perform(120, [](size_t t) {
    FlatPose pose = walking(t);
    Rng rng(t);
    for (int p = 0; p < kBodyPoints; ++p)
      if (rng.uniform() < 0.3f) pose.forget(p);
    return pose;
  });
  for (const FlatPose& pose : made) {
    EXPECT_TRUE(pose.body.allFinite());
    EXPECT_LT(box_of(pose).sizes().maxCoeff(), 3000);
  }
}

std::vector<std::string> engine_names() {
  return names_of(flat_engines());
}
INSTANTIATE_TEST_SUITE_P(Every, FlatEngines, ::testing::ValuesIn(engine_names()),
                         [](const auto& info) { return info.param; });

TEST(FlatEngine, IsMadeUnderItsOwnName) {
  for (const MethodChoice& engine : flat_engines())
    EXPECT_EQ(nn::load_keypoint_transfer(shipped_weights(), {engine.name, true, 30})->name(), engine.name);
  EXPECT_NE(failure_of([] {
              nn::load_keypoint_transfer(shipped_weights(), {"copy", true, 30});
            }).find("is for what moves in space"),
            std::string::npos);
}

}  // namespace
}  // namespace understudy
