#include "retarget/pipeline/hand_contacts.hpp"

#include <gtest/gtest.h>

#include <map>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/hand_contact.hpp"
#include "tests/support/hand_poses.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr float kFrame = 1 / 30.0f;

/// Made once each: it takes a while.
const ShapedBody& person(float girth, float stature = 1.70f) {
  static std::map<std::pair<float, float>, ShapedBody> made;
  const auto [at, is_new] = made.try_emplace({girth, stature});
  if (!is_new) return at->second;
  PersonOptions options;
  options.girth = girth;
  options.stature = stature;
  return at->second = builtin_person(options);
}

/// A source, a target, and what the target does.
struct HandStage {
  ShapedBody source, target;
  HandContacts hands;
  HandContact evaluator;

  HandStage(ShapedBody from, ShapedBody onto)
      : source(std::move(from)),
        target(std::move(onto)),
        evaluator(target.vertices, target.faces, target.joints) {
    hands.bind(Mesh{target.vertices, target.faces}, target.joints, target.weights);
  }
  /// One frame of the source, its rotations copied, and the hands put where they belong.
  Pose push(const Pose& pose) {
    const PosedSkeleton posed = forward_kinematics(source.joints, pose);
    const BodyGirth girth = measure_girth(posed.joints, posed.global, posed_vertices(source, pose));
    return hands.push(pose, posed.joints, girth, kFrame);
  }
  /// The source looked at with its arms away first, then for half a second in this pose.
  Pose settled(const Pose& pose) {
    for (int t = 0; t < 5; ++t) push(Pose{});
    Pose result;
    for (int t = 0; t < 15; ++t) result = push(pose);
    return result;
  }
  HandGaps gaps(const Pose& pose) const { return evaluator.gaps(posed_vertices(target, pose)); }
  double buried(const Pose& pose) const { return evaluator.buried(posed_vertices(target, pose)); }
};

Pose hand_on_belly(const ShapedBody& body) {
  Pose pose;
  place_hand(body, 0, front_of(body, 0.15f) + Vec3(0.02f, 0, 0.015f), pose);
  return pose;
}

TEST(HandContacts, AHandOnTheBellyIsOnTheBellyOfAHeavierPerson) {
  HandStage stage(person(0.8f), person(1.6f));
  const Pose copied = hand_on_belly(stage.source), kept = stage.settled(copied);
  EXPECT_GT(stage.buried(copied), 0.15);
  EXPECT_LT(stage.buried(kept), 0.3 * stage.buried(copied));
  EXPECT_LT(stage.gaps(kept)[0][TouchTorso], 0.02f);
}

TEST(HandContacts, AHandOnTheBellyIsOnTheBellyOfAThinnerPerson) {
  HandStage stage(person(1.6f), person(0.8f));
  const Pose copied = hand_on_belly(stage.source), kept = stage.settled(copied);
  EXPECT_GT(stage.gaps(copied)[0][TouchTorso], 0.04f);
  EXPECT_LT(stage.gaps(kept)[0][TouchTorso], 0.02f);
  EXPECT_LT(stage.buried(kept), 0.05);
}

TEST(HandContacts, HandsThatTouchEachOtherDoSoAfterATransferThatTookThemApartAndMeetHalfWay) {
  HandStage stage(person(1.0f), person(1.0f));
  const Vec3 middle = front_of(stage.source, 0.2f) + Vec3(0, 0.05f, 0.12f);
  Pose pose;
  place_hand(stage.source, 0, middle + Vec3(0.075f, 0, 0), pose);  // the fingertips meet
  place_hand(stage.source, 1, middle - Vec3(0.075f, 0, 0), pose);
  ASSERT_LT(stage.gaps(pose)[0][TouchOtherHand], 0.02f);
  Pose apart = pose, kept;
  apart.local[RightShoulder] = rotation_about_y(-0.25f) * pose.local[RightShoulder];
  ASSERT_GT(stage.gaps(apart)[0][TouchOtherHand], 0.04f);
  const Joints seen = forward_kinematics(stage.source.joints, pose).joints;
  for (int t = 0; t < 15; ++t) kept = stage.hands.push(apart, seen, std::nullopt, kFrame);
  EXPECT_LT(stage.gaps(kept)[0][TouchOtherHand], 0.03f);
  const auto [left, right] = stage.hands.moved();
  EXPECT_LT(std::max(left, right), 2 * std::min(left, right));
}

TEST(HandContacts, TheSamePersonDoesTheSame) {
  HandStage stage(person(1.0f), person(1.0f));
  const Pose copied = hand_on_belly(stage.source), kept = stage.settled(copied);
  const Joints before = forward_kinematics(stage.target.joints, copied).joints,
               after = forward_kinematics(stage.target.joints, kept).joints;
  EXPECT_LT((before - after).rowwise().norm().maxCoeff(), 0.01f);
}

TEST(HandContacts, ChangesNothingFarFromTheBody) {
  HandStage stage(person(0.8f), person(1.6f));
  const Pose kept = stage.settled(Pose{});
  for (const Mat3& R : kept.local) EXPECT_EQ(R, Mat3(Mat3::Identity()));
}

TEST(HandContacts, ChangesArmsOnlyAndKeepsTheHandsRotations) {
  HandStage stage(person(1.6f), person(0.8f));
  const Pose copied = hand_on_belly(stage.source), kept = stage.settled(copied);
  const auto before = forward_kinematics(stage.target.joints, copied),
             after = forward_kinematics(stage.target.joints, kept);
  EXPECT_GT((before.joints.row(LeftWrist) - after.joints.row(LeftWrist)).norm(), 0.03f);
  EXPECT_LT(geodesic_angle(before.global[LeftWrist], after.global[LeftWrist]), 2e-3f);
  for (const int j : {Pelvis, Head, LeftShoulder, RightWrist, LeftFoot})
    EXPECT_LT((before.joints.row(j) - after.joints.row(j)).norm(), 1e-5f) << j;
}

TEST(HandContacts, WithoutScansASourceIsAsThickAsAHuman) {
  HandStage stage(person(1.0f), person(1.7f));
  const Pose copied = hand_on_belly(stage.source);
  const Joints seen = forward_kinematics(stage.source.joints, copied).joints;
  Pose kept;
  for (int t = 0; t < 15; ++t) kept = stage.hands.push(copied, seen, std::nullopt, kFrame);
  EXPECT_LT(stage.buried(kept), 0.5 * stage.buried(copied));
  EXPECT_LT(stage.gaps(kept)[0][TouchTorso], 0.02f);
}

/// A hand that goes to the belly and away again, within 2 s.
std::vector<Pose> strokes(const ShapedBody& body) {
  std::vector<Pose> result;
  for (int t = 0; t < 60; ++t) {
    Pose pose;
    const float away = 0.15f + 0.15f * std::cos(2 * kPi * static_cast<float>(t) / 60);
    place_hand(body, 0, front_of(body, 0.15f) + Vec3(0.02f, 0, 0.015f + away), pose);
    result.push_back(pose);
  }
  return result;
}

TEST(HandContacts, NothingPops) {
  HandStage stage(person(1.6f), person(0.8f));
  float most = 0, most_before = 0;
  std::array<Vec3, 3> path, path_before;
  int t = 0;
  for (const Pose& pose : strokes(stage.source)) {
    std::rotate(path.begin(), path.begin() + 1, path.end());
    std::rotate(path_before.begin(), path_before.begin() + 1, path_before.end());
    path_before[2] = forward_kinematics(stage.target.joints, pose).joints.row(LeftWrist).transpose();
    path[2] = forward_kinematics(stage.target.joints, stage.push(pose)).joints.row(LeftWrist).transpose();
    if (++t < 3) continue;
    most = std::max(most, (path[2] - 2 * path[1] + path[0]).norm());
    most_before = std::max(most_before, (path_before[2] - 2 * path_before[1] + path_before[0]).norm());
  }
  EXPECT_LT(most, most_before + 0.025f);  // metres a frame squared
}

TEST(HandContacts, LooksOnlyBackAndStartsAnew) {
  HandStage stage(person(1.6f), person(0.8f));
  const auto poses = strokes(stage.source);
  std::vector<Pose> all;
  for (const Pose& pose : poses) all.push_back(stage.push(pose));
  stage.hands.reset();
  for (size_t t = 0; t < 30; ++t) {
    const Pose now = stage.push(poses[t]);
    for (size_t j = 0; j < kJointCount; ++j) ASSERT_EQ(now.local[j], all[t].local[j]) << t;
  }
}

TEST(HandContacts, RefusesWhatDoesNotFit) {
  const ShapedBody body = person(1.0f);
  HandContacts hands;
  EXPECT_THROW(hands.push(Pose{}, body.joints, std::nullopt, kFrame), Error);
  EXPECT_THROW(hands.bind(Mesh{body.vertices, body.faces}, body.joints, body.weights.topRows(10)), Error);
  hands.bind(Mesh{body.vertices, body.faces}, body.joints, body.weights);
  Joints bad = body.joints;
  bad(3, 1) = NAN;
  EXPECT_THROW(hands.push(Pose{}, bad, std::nullopt, kFrame), Error);
}

TEST(HandContacts, ABodyWithoutFacesOrHandsIsLeftInPeace) {
  const ShapedBody body = person(1.0f);
  RowMatrix weights = RowMatrix::Zero(body.weights.rows(), kJointCount);
  weights.col(Pelvis).setOnes();
  HandContacts hands;
  hands.bind(Mesh{body.vertices}, body.joints, weights);
  const Pose kept = hands.push(Pose{}, body.joints, std::nullopt, kFrame);
  for (const Mat3& R : kept.local) EXPECT_EQ(R, Mat3(Mat3::Identity()));
}

TEST(BodyGirth, TellsAHeavyPersonFromAThinOne) {
  for (const float girth : {0.8f, 1.6f}) {
    const ShapedBody body = person(girth);
    const BodyGirth seen = measure_girth(body.joints, identity_rotations(), body.vertices);
    const float belly = seen.radius[1][2], front = front_of(body, 0.12f).z();
    EXPECT_NEAR(belly, front - 0.5f * (body.joints(Spine1, 2) + body.joints(Spine2, 2)), 0.03f) << girth;
  }
}

TEST(BodyGirth, IsTheSameInAnotherPose) {
  const ShapedBody body = person(1.2f);
  const Motion dance = builtin_motion("dance", body.joints);
  RunningGirth running;
  for (size_t t = 0; t < dance.poses.size(); t += 3) {
    Extraction seen;
    seen.joints = forward_kinematics(body.joints, dance.poses[t]).joints;
    running.push(measure_girth(seen, posed_vertices(body, dance.poses[t])));
  }
  const BodyGirth still = measure_girth(body.joints, identity_rotations(), body.vertices),
                  moving = running.value(leg_length(body.joints));
  for (const size_t s : {0, 1, 2, 4, 5, 6})
    for (size_t d = 0; d < BodyGirth::kDirections; ++d)
      if (still.radius[s][d] > 0)
        EXPECT_NEAR(moving.radius[s][d], still.radius[s][d], 0.035f) << s << " " << d;
}

}  // namespace
}  // namespace understudy
