// Frames that cannot be used, predicted from those before: by itself, and in the performer.
#include "retarget/pipeline/pose_prediction.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/performer.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

struct Predicted {
  Joints rest = human_rest();
  Motion walk = builtin_motion("walk", rest);

  /// Mean error of joints over `frames` after frame `last`, metres; `frozen`: of the last pose.
  float error(int last, int frames, bool frozen) const {
    PosePrediction prediction;
    for (int t = 0; t <= last; ++t) prediction.push(walk.poses[t], {}, 1 / walk.fps);
    float sum = 0;
    for (int i = 1; i <= frames; ++i) {
      const Pose made = frozen ? walk.poses[last] : prediction.after(static_cast<float>(i) / walk.fps, rest);
      sum += (forward_kinematics(rest, made).joints - forward_kinematics(rest, walk.poses[last + i]).joints)
                 .rowwise()
                 .norm()
                 .mean();
    }
    return sum / static_cast<float>(frames);
  }
};

TEST(PosePrediction, OfAWalkErrsLessThanStandingStill) {
  const Predicted stage;
  for (const int last : {20, 33, 47, 60, 75}) {
    EXPECT_LT(stage.error(last, 3, false), 0.6f * stage.error(last, 3, true)) << last;
    EXPECT_LT(stage.error(last, 15, false), stage.error(last, 15, true)) << last;
  }
}

TEST(PosePrediction, ComesToRestAndHoldsAfterHalfASecond) {
  const Predicted stage;
  PosePrediction prediction;
  for (int t = 0; t <= 40; ++t) prediction.push(stage.walk.poses[t], {}, 1 / 30.0f);
  const auto at = [&](float seconds) { return prediction.after(seconds, stage.rest); };
  EXPECT_GT((at(0.1f).root - at(0).root).norm(), 0.05f);
  EXPECT_LT((at(0.5f).root - at(0.45f).root).norm(), 0.01f);
  EXPECT_EQ(at(0.5f).root, at(60).root);
  EXPECT_EQ(at(0.5f).local, at(60).local);
  EXPECT_EQ(at(0).root, stage.walk.poses[40].root);
}

TEST(PosePrediction, KeepsFeetThatStoodWhereTheyStood) {
  const Predicted stage;
  PosePrediction prediction;
  for (int t = 0; t <= 40; ++t) prediction.push(stage.walk.poses[t], {true, false}, 1 / 30.0f);
  const auto ankle = [&](const Pose& pose, int joint) -> Vec3 {
    return forward_kinematics(stage.rest, pose).joints.row(joint).transpose();
  };
  const Pose made = prediction.after(0.2f, stage.rest);
  EXPECT_LT((ankle(made, LeftAnkle) - ankle(stage.walk.poses[40], LeftAnkle)).norm(), 0.02f);
  EXPECT_GT((ankle(made, RightAnkle) - ankle(stage.walk.poses[40], RightAnkle)).norm(), 0.02f);
}

TEST(PosePrediction, KnowsNoSpeedOfOneFrameOrAfterALongWait) {
  const Predicted stage;
  PosePrediction prediction;
  EXPECT_THROW(prediction.after(0.1f, stage.rest), Error);
  prediction.push(stage.walk.poses[0], {}, 1 / 30.0f);
  EXPECT_EQ(prediction.after(0.3f, stage.rest).root, stage.walk.poses[0].root);
  prediction.push(stage.walk.poses[20], {}, 20 / 30.0f);
  EXPECT_EQ(prediction.after(0.3f, stage.rest).root, stage.walk.poses[20].root);
  prediction.push(stage.walk.poses[21], {}, 1 / 30.0f);
  EXPECT_NE(prediction.after(0.3f, stage.rest).root, stage.walk.poses[21].root);
  prediction.reset();
  EXPECT_THROW(prediction.after(0.1f, stage.rest), Error);
}

struct Predicting {
  explicit Predicting(bool predict) {
    RetargetOptions options;
    options.predict = predict;
    performer.emplace(prepare_target(target.mesh, rest), std::make_shared<CopyTransfer>(),
                      std::make_shared<RigidDeformer>(target.weights), options);
  }
  PerformedFrame push(int i) {
    Observation seen;
    seen.joints = forward_kinematics(human_rest(), dance(static_cast<float>(i) / 30)).joints;
    return performer->perform(seen, 1 / 30.0f);
  }
  PerformedFrame miss() { return performer->perform(without_skeleton("nothing was captured"), 1 / 30.0f); }

  Joints rest = other_body();
  PointBody target{rest};
  std::optional<Performer> performer;
};

bool same_result(const PerformedFrame& a, const PerformedFrame& b) {
  return a.pose.local == b.pose.local && a.pose.root == b.pose.root && a.vertices == b.vertices &&
         a.standing == b.standing && a.flagged == b.flagged;
}

TEST(PosePrediction, InThePerformerIsOffAtFirstAndChangesFlaggedFramesAlone) {
  Predicting still(false), ahead(true);
  PerformedFrame last;
  for (int i = 0; i < 60; ++i) {
    const bool misses = i >= 20 && i < 26;
    const PerformedFrame a = misses ? still.miss() : still.push(i), b = misses ? ahead.miss() : ahead.push(i);
    EXPECT_EQ(a.flagged, misses);
    EXPECT_EQ(b.flagged, misses) << "it stays flagged";
    EXPECT_EQ(same_result(a, b), !misses) << i << ": no trace in what comes after";
    if (misses) EXPECT_TRUE(a.pose.local == last.pose.local) << "as ever";
    EXPECT_EQ(kept(a).doubt_m, 0);
    EXPECT_EQ(kept(b).doubt_m > 0, misses) << i << ": what was made tells its doubt";
    if (!misses) last = a;
  }
}

TEST(PosePrediction, InThePerformerLooksAtThePastAlone) {
  Predicting whole(true), cut(true);
  std::vector<PerformedFrame> frames;
  const auto next = [](Predicting& of, int i) { return i % 9 >= 6 ? of.miss() : of.push(i); };
  for (int i = 0; i < 40; ++i) frames.push_back(next(whole, i));
  for (int i = 0; i < 25; ++i) EXPECT_TRUE(same_result(next(cut, i), frames[static_cast<size_t>(i)])) << i;
  whole.performer->restart();
  for (int i = 0; i < 25; ++i)
    EXPECT_TRUE(same_result(next(whole, i), frames[static_cast<size_t>(i)])) << "started anew: " << i;
}

TEST(PosePrediction, BeforeAnyGoodFrameThereIsNone) {
  Predicting ahead(true);
  const PerformedFrame frame = ahead.miss();
  EXPECT_TRUE(frame.flagged);
  EXPECT_EQ(frame.pose.root, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace understudy
