#include "retarget/editing/pose_fill.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/editing/pose_edits.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct FilledWalk {
  Joints rest = builtin_person().joints;
  Motion walk = builtin_motion("walk", rest);

  Motion filled(int first, int last) const {
    Motion motion = walk;
    fill_frames({{first, last}}, rest, nullptr, motion);
    return motion;
  }
  /// Mean distance of joints from the truth in these frames, metres.
  double error(const Motion& motion, int first, int last) const {
    double sum = 0;
    for (int t = first; t <= last; ++t)
      sum += static_cast<double>(
          (forward_kinematics(rest, motion.poses[t]).joints - forward_kinematics(rest, walk.poses[t]).joints)
              .rowwise()
              .norm()
              .mean());
    return sum / (last - first + 1);
  }
};

const FilledWalk& stage() {
  static const FilledWalk made;
  return made;
}

bool same(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
}

TEST(PoseFill, LeavesKnownFramesAsTheyAre) {
  const Motion motion = stage().filled(20, 26);
  for (int t = 0; t < static_cast<int>(motion.poses.size()); ++t)
    EXPECT_EQ(same(motion.poses[t], stage().walk.poses[t]), t < 20 || t > 26) << t;
}

TEST(PoseFill, ComesNearToAWalk) {
  EXPECT_LT(stage().error(stage().filled(20, 24), 20, 24), 0.01);
  Motion held = stage().walk;
  for (int t = 20; t <= 24; ++t) held.poses[t] = held.poses[19];
  EXPECT_GT(stage().error(held, 20, 24), 0.05);
}

TEST(PoseFill, KeepsTheSpeedAtBothEnds) {
  const Motion motion = stage().filled(20, 29);
  const auto speed = [&](const Motion& m, int t) -> Vec3 { return m.poses[t + 1].root - m.poses[t].root; };
  for (const int t : {19, 29})
    EXPECT_LT((speed(motion, t) - speed(stage().walk, t == 19 ? 18 : 30)).norm(), 0.006f) << t;
}

TEST(PoseFill, TurnsAndMirrorsWithWhatIsKnown) {
  const Motion filled = stage().filled(20, 29);
  Motion turned = stage().walk, mirror = stage().walk;
  const Mat3 R = rotation_about_y(2);
  for (Pose& pose : turned.poses) pose.root = R * pose.root, pose.local[Pelvis] = R * pose.local[Pelvis];
  for (Pose& pose : mirror.poses) pose = mirrored(pose);
  fill_frames({{20, 29}}, stage().rest, nullptr, turned);
  fill_frames({{20, 29}}, stage().rest, nullptr, mirror);
  for (int t = 20; t <= 29; ++t) {
    EXPECT_LT((R * filled.poses[t].root - turned.poses[t].root).norm(), 1e-3f);
    const Pose other = mirrored(filled.poses[t]);
    EXPECT_LT((other.root - mirror.poses[t].root).norm(), 1e-3f);
    for (int j = 0; j < kJointCount; ++j)
      EXPECT_LT(geodesic_angle(other.local[j], mirror.poses[t].local[j]), 2e-3f);
  }
}

TEST(PoseFill, ATurnOfMoreThanHalfACircleGoesTheShortWay) {
  Motion spin;
  spin.poses.resize(12);
  for (int t = 0; t < 12; ++t) spin.poses[t].local[Pelvis] = rotation_about_y(0.28f * static_cast<float>(t));
  const Motion truth = spin;
  fill_frames({{2, 9}}, stage().rest, nullptr, spin);
  for (int t = 2; t <= 9; ++t)
    EXPECT_LT(geodesic_angle(spin.poses[t].local[Pelvis], truth.poses[t].local[Pelvis]), 0.02f) << t;
}

TEST(PoseFill, HoldsAFootThatStandsOnBothSides) {
  Motion motion = stage().walk;
  motion.standing.assign(motion.poses.size(), {false, false});
  // The frames in which the left ankle moves least.
  const auto ankle = [&](const Motion& m, int t) -> Vec3 {
    return forward_kinematics(stage().rest, m.poses[t]).joints.row(LeftAnkle).transpose();
  };
  int still = 2;
  for (int t = 2; t + 10 < static_cast<int>(motion.poses.size()); ++t)
    if ((ankle(motion, t + 8) - ankle(motion, t)).norm() <
        (ankle(motion, still + 8) - ankle(motion, still)).norm())
      still = t;
  ASSERT_LT((ankle(motion, still + 8) - ankle(motion, still)).norm(), 0.04f);
  for (int t = still; t <= still + 8; ++t) motion.standing[t][0] = true;
  const Vec3 from = ankle(motion, still), to = ankle(motion, still + 8);
  fill_frames({{still + 1, still + 7}}, stage().rest, nullptr, motion);
  for (int t = still + 1; t < still + 8; ++t) {
    const float share = static_cast<float>(t - still) / 8;
    EXPECT_LT((ankle(motion, t) - (from + share * (to - from))).norm(), 2e-3f) << t;
    EXPECT_TRUE(motion.standing[t][0]);
    EXPECT_FALSE(motion.standing[t][1]);
  }
}

TEST(PoseFill, ALongGapNeitherSpinsNorRunsAway) {
  Motion motion = stage().walk;
  const size_t count = motion.poses.size();
  for (int i = 0; i < 900; ++i) motion.poses.insert(motion.poses.begin() + 20, motion.poses[20]);
  for (size_t t = 920; t < motion.poses.size(); ++t) motion.poses[t].root.z() += 1;
  const Vec3 from = motion.poses[19].root, to = motion.poses[920].root;
  fill_frames({{20, 919}}, stage().rest, nullptr, motion);
  EXPECT_EQ(motion.poses.size(), count + 900);
  for (int t = 20; t < 920; ++t) {
    EXPECT_LT(geodesic_angle(motion.poses[t - 1].local[LeftHip], motion.poses[t].local[LeftHip]), 0.2f) << t;
    const float way = (motion.poses[t].root - from).norm();
    EXPECT_LT(way, (to - from).norm() + 0.3f) << t;
  }
  // In the middle it stands nearly still.
  EXPECT_LT((motion.poses[470].root - motion.poses[469].root).norm() * motion.fps, 0.1f);
  EXPECT_GT(motion.doubt_m[470], 3 * motion.doubt_m[25]);
}

TEST(PoseFill, SaysWhatIsAGuess) {
  EXPECT_EQ(guess_of({10, 20}, 100, 30), "");
  EXPECT_EQ(guess_of({0, 20}, 100, 30), "frames 0 to 20 are a guess: nothing before them is known");
  EXPECT_EQ(guess_of({90, 99}, 100, 30), "frames 90 to 99 are a guess: nothing after them is known");
  EXPECT_EQ(guess_of({10, 909}, 1000, 30),
            "frames 10 to 909 are 30.0 seconds: what happens in the middle of them is a guess");
}

/// Answers with everybody's left arm raised.
class RaisedArm final : public MotionSpace {
 public:
  Completion complete(const KnownMotion& question) override {
    Completion made{question.motion, std::vector<float>(question.known.size())};
    for (size_t t = 0; t < question.known.size(); ++t) {
      if (question.known[t] == all_parts(true)) continue;
      made.motion.poses[t] = Pose();
      made.motion.poses[t].local[LeftShoulder] = rotation_from_axis_angle({0, 0, 1});
      made.doubt_m[t] = 0.5f;
    }
    return made;
  }
  std::string name() const override { return "raised arm"; }
};

TEST(PoseFill, TakesAsMuchOfTheLearnedAnswerAsIsWanted) {
  RaisedArm space;
  const auto filled = [&](float learned) {
    Motion motion = stage().walk;
    fill_frames({{20, 29, learned}, {35, 37, 0}}, stage().rest, &space, motion);
    return motion;
  };
  const Motion plain = filled(0), half = filled(0.5f), whole = filled(1);
  const Pose raised = Pose();
  for (int t = 0; t < static_cast<int>(plain.poses.size()); ++t) {
    const bool learns = t >= 20 && t <= 29;
    EXPECT_EQ(same(plain.poses[t], whole.poses[t]), !learns) << t;
    EXPECT_EQ(plain.doubt_m[t] > 0, learns || (t >= 35 && t <= 37)) << t;
    if (!learns) continue;
    EXPECT_EQ(whole.poses[t].root, raised.root);
    EXPECT_EQ(whole.doubt_m[t], 0.5f);
    EXPECT_NEAR((half.poses[t].root - plain.poses[t].root).norm(), 0.5f * plain.poses[t].root.norm(), 1e-4f);
    EXPECT_NEAR(geodesic_angle(half.poses[t].local[LeftKnee], plain.poses[t].local[LeftKnee]),
                0.5f * geodesic_angle(raised.local[LeftKnee], plain.poses[t].local[LeftKnee]), 1e-3f);
  }
}

TEST(PoseFill, PredictsAtTheEnds) {
  const int count = static_cast<int>(stage().walk.poses.size());
  const Motion on = stage().filled(count - 3, count - 1);
  EXPECT_LT(stage().error(on, count - 3, count - 1), 0.04);
  const auto speed = [&](const Motion& m, int t) { return (m.poses[t + 1].root - m.poses[t].root).norm(); };
  EXPECT_GT(speed(on, count - 4), 0.5f * speed(stage().walk, count - 5));
  const Motion before = stage().filled(0, 2);
  EXPECT_LT(stage().error(before, 0, 2), 0.04);
  const Motion rest = stage().filled(10, count - 1);
  EXPECT_LT(speed(rest, count - 2), 0.05f * speed(stage().walk, 8));  // it has come to rest
}

TEST(PoseFill, RefusesFramesThatAreNotThere) {
  const int count = static_cast<int>(stage().walk.poses.size());
  Motion motion = stage().walk;
  EXPECT_EQ(failure_of([&] {
              fill_frames({{0, count - 1}}, stage().rest, nullptr, motion);
            }),
            "all frames are to be filled: none is left that is known");
  EXPECT_THROW(fill_frames({{5, count}}, stage().rest, nullptr, motion), Error);
  EXPECT_THROW(fill_frames({{5, 4}}, stage().rest, nullptr, motion), Error);
  EXPECT_THROW(fill_frames({{-1, 4}}, stage().rest, nullptr, motion), Error);
}

TEST(GoingOn, MakesTheMotionLongerAndLeavesWhatWasThere) {
  Motion motion = stage().walk;
  const size_t count = motion.poses.size();
  motion.flags.assign(count, 0);
  motion.standing.assign(count, {false, false});
  go_on({1.5f}, stage().rest, nullptr, motion);
  ASSERT_EQ(motion.poses.size(), count + 45);
  EXPECT_EQ(motion.flags.size(), count + 45);
  EXPECT_EQ(motion.standing.size(), count + 45);
  for (size_t t = 0; t < motion.poses.size(); ++t) {
    if (t < count) EXPECT_TRUE(same(motion.poses[t], stage().walk.poses[t])) << t;
    EXPECT_EQ(motion.doubt_m[t] > 0, t >= count) << t;
    if (t > count) EXPECT_GT(motion.doubt_m[t], motion.doubt_m[t - 1]) << "farther from what is known: " << t;
  }
  const float before = (motion.poses[count - 1].root - motion.poses[count - 2].root).norm();
  EXPECT_NEAR((motion.poses[count].root - motion.poses[count - 1].root).norm(), before, 0.2f * before);
}

TEST(GoingOn, AsksTheMotionSpaceAgainFromWhatItMade) {
  /// One frame after the other a step farther than the last known one.
  class Strides final : public MotionSpace {
   public:
    int asked = 0;
    Completion complete(const KnownMotion& question) override {
      ++asked;
      Completion made{question.motion, std::vector<float>(question.known.size())};
      for (size_t t = 1; t < question.known.size(); ++t) {
        if (question.known[t] == all_parts(true)) continue;
        made.motion.poses[t] = made.motion.poses[t - 1];
        made.motion.poses[t].root.z() += 0.01f;
        made.doubt_m[t] = made.doubt_m[t - 1] + 0.001f;
      }
      return made;
    }
    std::string name() const override { return "strides"; }
  } space;
  Motion motion = stage().walk;
  const size_t count = motion.poses.size();
  go_on({3}, stage().rest, &space, motion);
  ASSERT_EQ(motion.poses.size(), count + 90);
  EXPECT_EQ(space.asked, 3) << "a second at a time";
  for (size_t t = count; t < motion.poses.size(); ++t) {
    EXPECT_NEAR(motion.poses[t].root.z() - motion.poses[t - 1].root.z(), 0.01f, 1e-5f) << t;
    EXPECT_NEAR(motion.doubt_m[t], 0.001f * static_cast<float>(t - count + 1), 1e-5f) << "it adds up: " << t;
  }
  Motion plain = stage().walk;
  go_on({3, 0}, stage().rest, &space, plain);
  EXPECT_EQ(space.asked, 3) << "nothing learned is wanted";
}

TEST(GoingOn, FollowsWhatWasFilledAndKeepsItsDoubt) {
  PoseEdits edits;
  edits.fill = {{20, 24}};
  edits.go_on = GoOnEdit{0.5f};
  const Motion made = apply_poses(edits, stage().walk, {stage().rest, {}});
  const size_t count = stage().walk.poses.size();
  ASSERT_EQ(made.poses.size(), count + 15);
  const Motion filled = stage().filled(20, 24);
  for (int t = 20; t <= 24; ++t) {
    EXPECT_TRUE(same(made.poses[t], filled.poses[t])) << t;
    EXPECT_EQ(made.doubt_m[t], filled.doubt_m[t]) << t;
  }
  EXPECT_GT(made.doubt_m.back(), 0);
  const EditCost cost = edit_cost(stage().walk, made, stage().rest);
  EXPECT_GT(cost.max_displacement_m, 0) << "over the frames that both have";
  EXPECT_FALSE(edits.empty());
  edits.fill.clear();
  EXPECT_FALSE(edits.empty());
  EXPECT_TRUE(need_space(edits));
  edits.go_on->learned = 0;
  EXPECT_FALSE(need_space(edits));
}

TEST(GoingOn, OfOneFrameStandsStillAndOfNoneIsRefused) {
  Motion motion;
  EXPECT_EQ(failure_of([&] { go_on({1}, stage().rest, nullptr, motion); }),
            "a motion without frames cannot go on");
  motion.poses.push_back(stage().walk.poses[7]);
  go_on({0.2f}, stage().rest, nullptr, motion);
  ASSERT_EQ(motion.poses.size(), 7u);
  for (const Pose& pose : motion.poses) EXPECT_LT((pose.root - motion.poses[0].root).norm(), 1e-5f);
  EXPECT_GT(motion.doubt_m.back(), 0);
}

}  // namespace
}  // namespace understudy
