#include "retarget/body/builtin_motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {
namespace {

constexpr const char* kMotions[] = {"walk", "dance"};

std::vector<PersonOptions> shapes() {
  PersonOptions tall, heavy, child;
  tall.stature = 1.85f;
  heavy.stature = 1.70f, heavy.girth = 1.45f, heavy.sex = 1, heavy.age = 45;
  child.stature = 1.12f, child.age = 6, child.sex = 1;
  return {tall, heavy, child};
}

JointSequence played(const Joints& rest, const Motion& motion) {
  JointSequence joints;
  for (const Pose& pose : motion.poses) joints.push_back(forward_kinematics(rest, pose).joints);
  return joints;
}

TEST(BuiltinMotion, FeetDoNotSkate) {
  for (const std::string name : kMotions)
    for (const PersonOptions& shape : shapes()) {
      const Joints rest = builtin_joints(shape);
      EXPECT_LE(foot_skate(played(rest, builtin_motion(name, rest)), 30), 0.03)
          << name << " stature " << shape.stature;
    }
}

TEST(BuiltinMotion, BothFeetTouchTheFloorAndNothingGoesThroughIt) {
  for (const PersonOptions& shape : shapes()) {
    const ShapedBody body = builtin_person(shape);
    for (const std::string name : kMotions) {
      const Motion motion = builtin_motion(name, body.joints);
      std::array<float, 2> lowest = {1, 1};
      for (size_t t = 0; t < motion.poses.size(); t += 4) {
        const PosedSkeleton posed = forward_kinematics(body.joints, motion.poses[t]);
        const Points v = linear_blend_skinning(body.vertices, body.weights, body.joints, posed);
        EXPECT_GT(v.col(1).minCoeff(), -0.015f) << name << " frame " << t << " stature " << shape.stature;
        for (int side = 0; side < 2; ++side)
          lowest[side] = std::min(lowest[side], posed.joints(LeftFoot + side, 1));
      }
      for (float y : lowest) EXPECT_LT(y, 0.03f) << name;
    }
  }
}

TEST(BuiltinMotion, JointsStayWithinWhatPeopleCanDo) {
  const auto limit = [](int j) {
    switch (j) {
      case Spine1:
      case Spine2:
      case Spine3:
        return 25.f;
      case Neck:
      case Head:
        return 45.f;
      case LeftHip:
      case RightHip:
        return 125.f;
      case LeftKnee:
      case RightKnee:
        return 150.f;
      case LeftAnkle:
      case RightAnkle:
        return 62.f;
      case LeftFoot:
      case RightFoot:
        return 46.f;
      case LeftCollar:
      case RightCollar:
        return 35.f;
      case LeftShoulder:
      case RightShoulder:
        return 150.f;
      case LeftElbow:
      case RightElbow:
        return 145.f;
      case LeftWrist:
      case RightWrist:
        return 60.f;
      default:
        return 90.f;
    }
  };
  for (const std::string name : kMotions)
    for (const PersonOptions& shape : shapes()) {
      const Motion motion = builtin_motion(name, builtin_joints(shape));
      for (const Pose& pose : motion.poses)
        for (int j = 0; j < kJointCount; ++j)
          ASSERT_LE(geodesic_angle(Mat3::Identity(), pose.local[j]) * 180 / kPi, limit(j))
              << name << " " << kJointNames[j];
    }
}

TEST(BuiltinMotion, KneesAndElbowsBendTheRightWayOnly) {
  for (const std::string name : kMotions)
    for (const Pose& pose : builtin_motion(name, builtin_joints()).poses) {
      for (int knee : {LeftKnee, RightKnee})
        ASSERT_GT(rotation_to_axis_angle(pose.local[knee]).x(), -0.05f) << name;
      ASSERT_LT(rotation_to_axis_angle(pose.local[LeftElbow]).y(), 0.05f) << name;
      ASSERT_GT(rotation_to_axis_angle(pose.local[RightElbow]).y(), -0.05f) << name;
    }
}

TEST(BuiltinMotion, MovesWithoutJumps) {
  for (const std::string name : kMotions) {
    const Joints rest = builtin_joints();
    const JointSequence joints = played(rest, builtin_motion(name, rest));
    for (size_t t = 1; t < joints.size(); ++t)
      ASSERT_LT((joints[t] - joints[t - 1]).rowwise().norm().maxCoeff() * 30, 14) << name << " frame " << t;
  }
}

TEST(BuiltinMotion, HipsAndShouldersCounterRotateInTheWalk) {
  const Joints rest = builtin_joints();
  double together = 0, hips = 0, shoulders = 0;
  for (const Joints& j : played(rest, builtin_motion("walk", rest))) {
    const double h = std::atan2(j(LeftHip, 2) - j(RightHip, 2), j(LeftHip, 0) - j(RightHip, 0));
    const double s =
        std::atan2(j(LeftShoulder, 2) - j(RightShoulder, 2), j(LeftShoulder, 0) - j(RightShoulder, 0));
    together += h * s, hips += h * h, shoulders += s * s;
  }
  EXPECT_LT(together / std::sqrt(hips * shoulders), -0.5);
}

TEST(BuiltinMotion, WalkGoesForwardWithTheLegsOfThePerson) {
  const auto distance = [](const PersonOptions& shape) {
    const Joints rest = builtin_joints(shape);
    const Motion walk = builtin_motion("walk", rest);
    return (walk.poses.back().root - walk.poses.front().root).z() / leg_length(rest);
  };
  EXPECT_GT(distance(shapes()[0]), 4);
  EXPECT_NEAR(distance(shapes()[0]), distance(shapes()[2]), 0.05);
}

TEST(BuiltinMotion, EveryMotionMovesPelvisSpineAndArms) {
  for (const std::string name : kMotions) {
    const Motion motion = builtin_motion(name, builtin_joints());
    for (int j : {static_cast<int>(Pelvis), static_cast<int>(Spine2), static_cast<int>(LeftShoulder),
                  static_cast<int>(RightElbow), static_cast<int>(LeftHip)}) {
      float most = 0;
      for (const Pose& pose : motion.poses)
        most = std::max(most, geodesic_angle(motion.poses[0].local[j], pose.local[j]));
      EXPECT_GT(most * 180 / kPi, 1.5f) << name << " " << kJointNames[j];
    }
  }
}

TEST(BuiltinMotion, LastsFiveOrSixSecondsAtAnyRate) {
  for (const std::string name : kMotions)
    for (float fps : {25.f, 30.f, 60.f, 120.f}) {
      const Motion motion = builtin_motion(name, builtin_joints(), fps);
      EXPECT_EQ(motion.fps, fps);
      EXPECT_GE(static_cast<float>(motion.poses.size()) / fps, 5) << name;
      EXPECT_LE(static_cast<float>(motion.poses.size()) / fps, 6) << name;
    }
}

TEST(BuiltinMotion, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(builtin_motion("moonwalk", builtin_joints()), Error);
  EXPECT_THROW(builtin_motion("walk", builtin_joints(), 0.0f), Error);
}

}  // namespace
}  // namespace understudy
