// Stride, hip height and arm reach of a target, on a walk and a dance of another body.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/skeleton/limb_ik.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

/// Nothing else moves limbs.
RetargetOptions bare() {
  RetargetOptions options;
  options.lock_feet = options.keep_contacts = options.vertices = false;
  return options;
}

struct Shaped {
  Joints rest_a = builtin_joints(), rest_b = other_body();
  PointBody body{rest_b};

  Performer performer(const RetargetOptions& options) const {
    return {prepare_target(body.mesh, rest_b), std::make_shared<CopyTransfer>(),
            std::make_shared<RigidDeformer>(body.weights), options};
  }
  Observation seen(const Pose& pose) const {
    Observation observation = fixtures::seen(forward_kinematics(rest_a, pose).joints);
    observation.global = global_rotations(pose.local);
    observation.exact = true;
    return observation;
  }
  std::vector<PerformedFrame> performed(const std::vector<Pose>& poses,
                                        const RetargetOptions& options) const {
    Performer one = performer(options);
    std::vector<PerformedFrame> frames;
    for (const Pose& pose : poses) frames.push_back(one.perform(seen(pose), 1 / 30.0f));
    return frames;
  }
  std::vector<Pose> walk() const { return builtin_motion("walk", rest_a).poses; }
  static std::vector<Pose> dancing() {
    std::vector<Pose> poses;
    for (int i = 0; i < 60; ++i) poses.push_back(dance(static_cast<float>(i) / 30));
    return poses;
  }
};

/// Mean speed, m/s, of feet where those of `standing` stand still.
double skate(const std::vector<PerformedFrame>& frames, const std::vector<PerformedFrame>& standing) {
  constexpr float kStill = 0.1f / 30;  // metres a frame
  double sum = 0;
  int count = 0;
  for (size_t t = 1; t < frames.size(); ++t)
    for (const int foot : {LeftFoot, RightFoot}) {
      const auto moved = [&](const std::vector<PerformedFrame>& of) {
        return (of[t].joints.row(foot) - of[t - 1].joints.row(foot)).norm();
      };
      if (moved(standing) > kStill) continue;
      sum += 30.0 * static_cast<double>(moved(frames));
      ++count;
    }
  return count > 20 ? sum / count : NAN;
}

Vec3 over_floor_from(const Joints& joints, int from, int to) {
  Vec3 way = (joints.row(to) - joints.row(from)).transpose();
  way.y() = 0;
  return way;
}

float longest_step(const std::vector<PerformedFrame>& frames) {
  float longest = 0;
  for (const PerformedFrame& frame : frames)
    longest = std::max(longest, over_floor_from(frame.joints, LeftAnkle, RightAnkle).norm());
  return longest;
}

float ankle_moved(const Joints& a, const Joints& b, int side) {
  return (a.row(LeftAnkle + side) - b.row(LeftAnkle + side)).norm();
}

TEST(Proportions, ThePathAndTheStepsGrowByTheStrideAndFeetDoNotSlide) {
  const Shaped shaped;
  RetargetOptions options = bare();
  const auto plain = shaped.performed(shaped.walk(), options);
  options.root.stride = 1.3f;
  const auto longer = shaped.performed(shaped.walk(), options);
  auto sliding = plain;  // the path alone
  const Vec3 start = plain[0].joints.row(Pelvis).transpose();
  for (size_t t = 0; t < plain.size(); ++t) {
    const Vec3 way = plain[t].joints.row(Pelvis).transpose() - start;
    const Vec3 far = longer[t].joints.row(Pelvis).transpose() - start;
    EXPECT_NEAR(far.x(), 1.3f * way.x(), 1e-3f) << t;
    EXPECT_NEAR(far.z(), 1.3f * way.z(), 1e-3f) << t;
    sliding[t].joints.rowwise() += Eigen::RowVector3f(0.3f * way.x(), 0, 0.3f * way.z());
  }
  EXPECT_GT(longest_step(longer), 1.15f * longest_step(plain));
  EXPECT_LT(skate(longer, plain), 0.4 * skate(sliding, plain));
}

TEST(Proportions, AStrideLeavesOneWhoStandsAsHeStands) {
  const Shaped shaped;
  const std::vector<Pose> standing(3, Pose{identity_rotations(), Vec3(0, 1, 0)});
  RetargetOptions options = bare();
  const Joints plain = shaped.performed(standing, options).back().joints;
  options.root.stride = 2;
  const Joints far = shaped.performed(standing, options).back().joints;
  const float stance = std::abs(over_floor_from(shaped.rest_b, LeftHip, LeftAnkle).norm());
  for (const int side : {0, 1}) EXPECT_LT(ankle_moved(plain, far, side), stance + 0.01f);
}

TEST(Proportions, ALoweredPelvisBendsTheKneesAndFeetStay) {
  const Shaped shaped;
  for (const bool lock : {false, true}) {
    RetargetOptions options = bare();
    options.lock_feet = lock;
    const auto plain = shaped.performed(shaped.walk(), options);
    options.root.hip_height_m = -0.08f;
    const auto low = shaped.performed(shaped.walk(), options);
    for (size_t t = 0; t < plain.size(); ++t) {
      EXPECT_NEAR(low[t].joints(Pelvis, 1), plain[t].joints(Pelvis, 1) - 0.08f, lock ? 0.01f : 1e-4f) << t;
      const PosedSkeleton a = forward_kinematics(shaped.rest_b, plain[t].pose),
                          b = forward_kinematics(shaped.rest_b, low[t].pose);
      for (const int side : {0, 1}) {
        EXPECT_LT(ankle_moved(a.joints, b.joints, side), lock ? 0.02f : 2e-3f) << t;
        const auto ankle = static_cast<size_t>(LeftAnkle + side);
        EXPECT_LT(geodesic_angle(a.global[ankle], b.global[ankle]), 3e-3f) << t;
      }
    }
  }
}

TEST(Proportions, ARaisedPelvisRisesAsFarAsStandingFeetReach) {
  const Shaped shaped;
  RetargetOptions options = bare();
  const auto plain = shaped.performed(Shaped::dancing(), options);
  options.root.hip_height_m = 0.05f;
  const auto high = shaped.performed(Shaped::dancing(), options);
  float most = 0;
  for (size_t t = 0; t < plain.size(); ++t) {
    const float raised = high[t].joints(Pelvis, 1) - plain[t].joints(Pelvis, 1);
    most = std::max(most, raised);
    EXPECT_GT(raised, -1e-4f) << t;
    EXPECT_LT(raised, 0.0501f) << t;
    EXPECT_LT(std::min(ankle_moved(plain[t].joints, high[t].joints, 0),
                       ankle_moved(plain[t].joints, high[t].joints, 1)),
              2e-3f)
        << t;
  }
  EXPECT_GT(most, 0.03f);
}

TEST(Proportions, HandsThatMeetMeetOnBroadShouldersWhereArmsReach) {
  const Shaped shaped;
  const Joints& rest = shaped.rest_a;
  Pose meeting{identity_rotations(), Vec3(0, 1, 0)};
  const Vec3 chest = 0.5f * (rest.row(LeftShoulder) + rest.row(RightShoulder)).transpose() -
                     rest.row(Pelvis).transpose() + meeting.root;
  for (const int side : {0, 1}) place_wrist(rest, side, chest + Vec3(0, -0.1f, 0.28f), meeting);
  const auto apart = [&](float reach) {
    RetargetOptions options = bare();
    options.arm_reach = reach;
    const Joints joints = shaped.performed({meeting}, options)[0].joints;
    return (joints.row(LeftWrist) - joints.row(RightWrist)).norm();
  };
  const float turned = apart(0), half = apart(0.5f), met = apart(1);
  EXPECT_GT(turned, 0.02f);
  EXPECT_NEAR(half, 0.5f * turned, 0.25f * turned);
  EXPECT_LT(met, 0.005f);
}

TEST(Proportions, AReachingHandKeepsItsRotation) {
  const Shaped shaped;
  RetargetOptions options = bare();
  const auto plain = shaped.performed(Shaped::dancing(), options);
  options.arm_reach = 1;
  const auto reaching = shaped.performed(Shaped::dancing(), options);
  for (size_t t = 0; t < plain.size(); ++t) {
    const Rotations a = global_rotations(plain[t].pose.local), b = global_rotations(reaching[t].pose.local);
    for (const size_t wrist : {LeftWrist, RightWrist})
      EXPECT_LT(geodesic_angle(a[wrist], b[wrist]), 3e-3f) << t;
    EXPECT_EQ(plain[t].pose.root, reaching[t].pose.root);
  }
}

TEST(RestPose, IsWhereTheTargetStandsWhereTheSourceIsInTPose) {
  const Shaped shaped;
  RetargetOptions options = bare();
  Rotations rest = identity_rotations();
  rest[LeftShoulder] = rotation_from_axis_angle(Vec3(0, 0, -0.6f));
  rest[LeftElbow] = rotation_from_axis_angle(Vec3(0, -0.4f, 0));
  options.rest_pose = rest;
  for (const float turn : {0.0f, 1.2f}) {  // and it turns with the body
    Pose t_pose{identity_rotations(), Vec3(0, 1, 0)};
    t_pose.local[Pelvis] = rotation_about_y(turn);
    const PerformedFrame frame = shaped.performed({t_pose}, options)[0];
    const Pose wanted{rest, frame.pose.root};
    Joints joints = forward_kinematics(shaped.rest_b, wanted).joints;
    const Eigen::RowVector3f root = frame.pose.root.transpose();
    joints = ((joints.rowwise() - root) * rotation_about_y(turn).transpose()).rowwise() + root;
    EXPECT_LT((joints - frame.joints).cwiseAbs().maxCoeff(), 1e-4f) << turn;
  }
}

TEST(RestPose, OfNoTurnChangesNextToNothing) {
  const Shaped shaped;
  RetargetOptions options = bare();
  const auto plain = shaped.performed(Shaped::dancing(), options);
  options.rest_pose = identity_rotations();
  const auto same = shaped.performed(Shaped::dancing(), options);
  for (size_t t = 0; t < plain.size(); ++t)
    EXPECT_LT((plain[t].joints - same[t].joints).cwiseAbs().maxCoeff(), 1e-4f) << t;
}

bool same_bytes(const Pose& a, const Pose& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;  // NOLINT: all floats
}

TEST(Proportions, DefaultsChangeNoByte) {
  const Shaped shaped;
  RootPath root;
  root.reset(shaped.body.mesh.vertices, shaped.rest_b);
  ArmReach arms;
  for (const Pose& pose : Shaped::dancing()) {
    EXPECT_TRUE(same_bytes(root.step(pose), pose));
    EXPECT_TRUE(same_bytes(arms.push(pose, shaped.rest_b, shaped.seen(pose).joints), pose));
  }
}

TEST(Performer, StartsAnewWithOtherOptionsAsOneMadeWithThem) {
  const Shaped shaped;
  RetargetOptions options;
  options.root.stride = 1.2f, options.root.hip_height_m = -0.03f, options.arm_reach = 0.5f;
  options.filter.smooth = false;
  Performer changed = shaped.performer({});
  for (const Pose& pose : Shaped::dancing()) changed.perform(shaped.seen(pose), 1 / 30.0f);
  changed.restart(options);
  const auto made = shaped.performed(Shaped::dancing(), options);
  for (size_t t = 0; t < made.size(); ++t) {
    const PerformedFrame frame = changed.perform(shaped.seen(Shaped::dancing()[t]), 1 / 30.0f);
    EXPECT_TRUE(same_bytes(frame.pose, made[t].pose)) << t;
  }
}

}  // namespace
}  // namespace understudy
