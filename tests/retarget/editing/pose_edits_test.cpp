#include "retarget/editing/pose_edits.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

struct EditedWalker {
  ShapedBody shape = builtin_person();
  EditedBody body = EditedBody::from(shape.vertices, shape.joints);
  Motion walk = builtin_motion("walk", shape.joints);
};

const EditedWalker& walker() {
  static const EditedWalker w;
  return w;
}

JointSequence joints(const Motion& motion) {
  JointSequence result;
  for (const Pose& pose : motion.poses) result.push_back(forward_kinematics(walker().body.rest, pose).joints);
  return result;
}

double skate(const Motion& motion) {
  return foot_skate(joints(motion), motion.fps);
}

/// The walk with a root that drifts: every foot slides.
Motion sliding_walk(const Vec3& drift = Vec3(0.25f, 0, -0.2f)) {
  Motion motion = walker().walk;
  for (size_t t = 0; t < motion.poses.size(); ++t)
    motion.poses[t].root += drift * (static_cast<float>(t) / motion.fps);
  return motion;
}

/// The fastest turn of any joint between neighbouring frames, radians a second.
float fastest_turn(const Motion& motion, std::initializer_list<int> which) {
  float fastest = 0;
  for (size_t t = 1; t < motion.poses.size(); ++t)
    for (const int j : which)
      fastest = std::max(fastest, geodesic_angle(motion.poses[t - 1].local[static_cast<size_t>(j)],
                                                 motion.poses[t].local[static_cast<size_t>(j)]) *
                                      motion.fps);
  return fastest;
}

float largest_difference(const Motion& a, const Motion& b) {
  float largest = 0;
  for (size_t t = 0; t < a.poses.size(); ++t) {
    largest = std::max(largest, (a.poses[t].root - b.poses[t].root).norm());
    for (size_t j = 0; j < kJointCount; ++j)
      largest = std::max(largest, geodesic_angle(a.poses[t].local[j], b.poses[t].local[j]));
  }
  return largest;
}

Motion smooth(const Motion& motion, float strength) {
  PoseEdits edits;
  edits.smooth = SmoothEdit{strength};
  return apply_poses(edits, motion, walker().body);
}

Motion pinned(const Motion& motion) {
  PoseEdits edits;
  edits.pin = PinEdit{};
  return apply_poses(edits, motion, walker().body);
}

TEST(RotateEdit, TurnsTheBoneAtItsFrameAndLessAround) {
  PoseEdits edits;
  edits.rotate = {{30, LeftElbow, Vec3(0, 0.5f, 0), 3}};
  const Motion motion = apply_poses(edits, walker().walk, walker().body);
  const auto turned = [&](int t) {
    return geodesic_angle(walker().walk.poses[static_cast<size_t>(t)].local[LeftElbow],
                          motion.poses[static_cast<size_t>(t)].local[LeftElbow]);
  };
  EXPECT_NEAR(turned(30), 0.5f, 1e-4f);
  EXPECT_NEAR(turned(32), 0.25f, 1e-3f);
  EXPECT_NEAR(turned(28), turned(32), 1e-3f);
  EXPECT_LT(turned(34), 1e-6f);
  edits.rotate = {{0, 22, Vec3::Zero(), 0}};
  EXPECT_THROW(apply_poses(edits, motion, walker().body), Error);
}

TEST(SmoothEdit, TakesNoiseOutWithoutDelay) {
  Motion noisy = walker().walk;
  Rng rng(1);
  for (Pose& pose : noisy.poses) {
    pose.root += 0.01f * Vec3(rng.normal(), rng.normal(), rng.normal());
    for (Mat3& R : pose.local)
      R = R * rotation_from_axis_angle(0.05f * Vec3(rng.normal(), rng.normal(), rng.normal()));
  }
  const Motion smoothed = smooth(noisy, 0.3f);
  const EditCost cost = edit_cost(noisy, smoothed, walker().body.rest);
  EXPECT_LT(cost.acceleration_after, 0.2 * cost.acceleration_before);
  EXPECT_GT(cost.mean_displacement_m, 0.005);
  EXPECT_LT(mean_joint_error(joints(smoothed), joints(walker().walk)),
            0.6 * mean_joint_error(joints(noisy), joints(walker().walk)));
}

TEST(SmoothEdit, LeavesEvenMotionAndHalfTurnsOfTheSign) {
  Motion even;
  for (int t = 0; t < 60; ++t) {
    Pose pose;
    pose.root = Vec3(0.02f * static_cast<float>(t), 1, 0);
    pose.local[Pelvis] =
        rotation_about_y(0.2f * static_cast<float>(t));  // twice about: quaternions change sign
    even.poses.push_back(pose);
  }
  EXPECT_LT(largest_difference(even, smooth(even, 1)), 2e-3f);
  EXPECT_EQ(smooth(even, 0).poses[7].local[Pelvis], even.poses[7].local[Pelvis]);
  EXPECT_THROW(smooth(even, 1.5f), Error);
}

TEST(TurnEdit, TurnsAboutTheFirstPelvis) {
  PoseEdits edits;
  edits.turn = TurnEdit{90};
  const Motion turned = apply_poses(edits, walker().walk, walker().body);
  const Vec3 way = walker().walk.poses.back().root - walker().walk.poses.front().root;
  const Vec3 after = turned.poses.back().root - turned.poses.front().root;
  EXPECT_EQ(turned.poses.front().root, walker().walk.poses.front().root);
  EXPECT_NEAR(after.x(), way.z(), 1e-4f);
  EXPECT_NEAR(after.y(), way.y(), 1e-4f);
  const auto bone = [](const Motion& m) {
    const Joints j = forward_kinematics(walker().body.rest, m.poses[10]).joints;
    return Vec3((j.row(Head) - j.row(LeftWrist)).transpose());
  };
  EXPECT_LT((rotation_about_y(kPi / 2) * bone(walker().walk) - bone(turned)).norm(), 1e-4f);
}

TEST(PoseEdits, TrimAndSkipByOriginalNumbers) {
  Motion motion = walker().walk;
  for (size_t t = 0; t < motion.poses.size(); ++t) motion.flags.push_back(t == 11);
  PoseEdits edits;
  edits.trim = Trim{10, 14};
  edits.skip = {0, 12, 14, 20000};
  EXPECT_EQ(kept_frames(edits, 150), (std::vector<int>{10, 11, 13}));
  const Motion whole = apply_poses(edits, motion, walker().body);
  EXPECT_EQ(whole.poses.size(), motion.poses.size());
  EXPECT_EQ(whole.flags, motion.flags);
  edits.trim = Trim{14, 10};
  EXPECT_THROW(kept_frames(edits, 150), Error);
}

TEST(PoseEdits, NoneLeaveTheMotion) {
  const Motion same = apply_poses(PoseEdits{}, walker().walk, walker().body);
  EXPECT_EQ(same.poses.size(), walker().walk.poses.size());
  EXPECT_EQ(largest_difference(same, walker().walk), 0);
  EXPECT_TRUE(PoseEdits{}.empty());
}

TEST(PoseEdits, FloorMovesTheBodyUp) {
  PoseEdits edits;
  edits.raise = RaiseEdit{0.07f};
  const Motion up = apply_poses(edits, walker().walk, EditedBody{walker().body.rest, {}});
  EXPECT_NEAR(up.poses[9].root.y() - walker().walk.poses[9].root.y(), 0.07f, 1e-6f);
}

TEST(PinEdit, StopsSlidingFeetAndTheKneesDoNotSnap) {
  const Motion sliding = sliding_walk(), held = pinned(sliding);
  RecordProperty("skate_truth", std::to_string(skate(walker().walk)));
  RecordProperty("skate_before", std::to_string(skate(sliding)));
  RecordProperty("skate_after", std::to_string(skate(held)));
  RecordProperty("turn_before",
                 std::to_string(fastest_turn(sliding, {LeftHip, RightHip, LeftKnee, RightKnee})));
  RecordProperty("turn_after", std::to_string(fastest_turn(held, {LeftHip, RightHip, LeftKnee, RightKnee})));
  EXPECT_GT(skate(sliding), 5 * skate(held));
  EXPECT_LT(fastest_turn(held, {LeftHip, RightHip, LeftKnee, RightKnee}),
            1.3f * fastest_turn(sliding, {LeftHip, RightHip, LeftKnee, RightKnee}));
}

TEST(PinEdit, LeavesAFootWhereItWasOnAverage) {
  // Drifting 0.32 m/s in stances of 0.7 s: 11 cm to both sides of the middle, not 22 cm to one.
  const auto before = joints(sliding_walk()), after = joints(pinned(sliding_walk()));
  float furthest = 0;
  for (size_t t = 0; t < before.size(); ++t)
    for (const int j : {LeftFoot, RightFoot})
      furthest = std::max(furthest, (before[t].row(j) - after[t].row(j)).norm());
  EXPECT_GT(furthest, 0.08f);
  EXPECT_LT(furthest, 0.15f);
}

TEST(PinEdit, WorksWithoutSoles) {
  PoseEdits edits;
  edits.pin = PinEdit{};
  const Motion sliding = sliding_walk();
  EXPECT_GT(skate(sliding), 5 * skate(apply_poses(edits, sliding, EditedBody{walker().body.rest, {}})));
}

TEST(PinEdit, HardlyChangesFeetThatStand) {
  const EditCost cost = edit_cost(walker().walk, pinned(walker().walk), walker().body.rest);
  EXPECT_LT(cost.mean_displacement_m, 0.004);
  EXPECT_LT(cost.max_displacement_m, 0.03);
}

TEST(PinEdit, PutsSolesOnTheFloor) {
  Motion sunk = walker().walk;
  for (Pose& pose : sunk.poses) pose.root.y() -= 0.03f;
  const auto deepest = [](const Motion& motion) {
    float low = 0;
    for (const Pose& pose : motion.poses) {
      const auto posed = forward_kinematics(walker().body.rest, pose);
      low = std::min(low, posed.joints(Pelvis, 1) + walker().body.soles.lowest(posed));
    }
    return low;
  };
  EXPECT_LT(deepest(sunk), -0.02f);
  EXPECT_GT(deepest(pinned(sunk)), -0.004f);
}

TEST(PinEdit, PutsTheSkinOnTheFloorWhateverTheHeightWas) {
  const ShapedBody& shape = walker().shape;
  for (const float height : {-0.03f, 0.025f}) {
    Motion moved = walker().walk;
    for (Pose& pose : moved.poses) pose.root.y() += height;
    const Motion held = pinned(moved);
    for (size_t t = 0; t < held.poses.size(); t += 7) {
      const Points skin = linear_blend_skinning(shape.vertices, shape.weights, shape.joints,
                                                forward_kinematics(shape.joints, held.poses[t]));
      EXPECT_NEAR(skin.col(1).minCoeff(), 0, 0.012f) << height << " frame " << t;
    }
  }
}

TEST(PinEdit, HoldsHeightsWhenNotAskedForTheFloor) {
  Motion raised = walker().walk;
  for (Pose& pose : raised.poses) pose.root.y() += 0.3f;  // on a table
  PoseEdits edits;
  edits.pin = PinEdit{};
  edits.pin->to_floor = false;
  const auto before = joints(raised), after = joints(apply_poses(edits, raised, walker().body));
  for (size_t t = 0; t < before.size(); ++t)
    EXPECT_NEAR(before[t](LeftAnkle, 1), after[t](LeftAnkle, 1), 5e-3f);
}

TEST(PinEdit, OfOneFootLeavesTheOther) {
  PoseEdits edits;
  edits.pin = PinEdit{};
  edits.pin->right = false;
  const Motion sliding = sliding_walk(), held = apply_poses(edits, sliding, walker().body);
  const auto before = joints(sliding), after = joints(held);
  float left = 0, right = 0;
  for (size_t t = 0; t < before.size(); ++t) {
    left = std::max(left, (before[t].row(LeftFoot) - after[t].row(LeftFoot)).norm());
    right = std::max(right, (before[t].row(RightFoot) - after[t].row(RightFoot)).norm());
  }
  EXPECT_GT(left, 0.03f);
  EXPECT_LT(right, 0.005f);
}

TEST(PinEdit, WorksAtHighRates) {
  Motion motion = builtin_motion("walk", walker().body.rest, 120);
  for (size_t t = 0; t < motion.poses.size(); ++t)
    motion.poses[t].root.x() += 0.3f * static_cast<float>(t) / 120;
  EXPECT_GT(skate(motion), 5 * skate(pinned(motion)));
}

TEST(PoseEdits, AreTheSameEveryTime) {
  const Motion short_one = sliding_walk(Vec3(0.1f, 0, 0));
  Motion motion;
  while (motion.poses.size() < 2000)
    motion.poses.insert(motion.poses.end(), short_one.poses.begin(), short_one.poses.end());
  motion.poses.resize(2000);
  PoseEdits edits;
  edits.rotate = {{50, Head, Vec3(0.2f, 0, 0), 10}};
  edits.smooth = SmoothEdit{0.5f};
  edits.raise = RaiseEdit{0.01f};
  edits.pin = PinEdit{};
  edits.turn = TurnEdit{30};
  const Motion once = apply_poses(edits, motion, walker().body);
  EXPECT_EQ(largest_difference(once, apply_poses(edits, motion, walker().body)), 0);
}

}  // namespace
}  // namespace understudy
