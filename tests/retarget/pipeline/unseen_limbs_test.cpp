#include "retarget/pipeline/unseen_limbs.hpp"

#include <gtest/gtest.h>

#include "retarget/base/rng.hpp"
#include "retarget/pipeline/performer.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr float kFrame_s = 1 / 30.0f;
const std::vector<int> kLegs = {LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftFoot, RightFoot};
const std::vector<int> kShins = {LeftAnkle, RightAnkle, LeftFoot, RightFoot};
const std::vector<int> kLeftArm = {LeftElbow, LeftWrist};

/// Who stands upright on y = 0, legs one metre long.
Pose standing() {
  Pose pose;
  pose.root = Vec3(0, 1.1219f, 0);
  return pose;
}

/// The frame of a person in this pose; `lost` joints are guessed badly, and said to be.
Extraction frame_of(const Pose& pose, const std::vector<int>& lost = {}, uint64_t seed = 1) {
  const PosedSkeleton posed = forward_kinematics(human_rest(), pose);
  Extraction seen;
  seen.joints = posed.joints;
  seen.global = posed.global;
  seen.confidence.setConstant(0.9f);
  Rng rng(seed);
  for (const int j : lost) {
    seen.joints.row(j) += 0.3f * Vec3(rng.normal(), rng.normal(), rng.normal()).transpose();
    seen.visibility[j] = seen.confidence[j] = 0.05f;
  }
  return seen;
}

Vec3 joint(const Extraction& seen, int j) {
  return seen.joints.row(j).transpose();
}

float lowest_foot(const Extraction& seen) {
  return std::min(seen.joints(LeftFoot, 1), seen.joints(RightFoot, 1));
}

TEST(UnseenLimbs, WhatIsSeenStaysAsItIs) {
  UnseenLimbs limbs;
  for (int t = 0; t < 60; ++t) {
    Extraction seen = frame_of(dance(0.1f * static_cast<float>(t)));
    seen.visibility.setConstant(0.6f);
    seen.visibility[LeftWrist] = 0.1f;  // behind the body for a moment, but known
    const Extraction result = limbs.push(seen, kFrame_s);
    EXPECT_EQ(result.joints, seen.joints);
    for (int j = 0; j < kJointCount; ++j) EXPECT_EQ((*result.global)[j], (*seen.global)[j]);
    EXPECT_TRUE((result.confidence == seen.confidence).all());
    EXPECT_EQ(limbs.limbs(), LimbsSight{});
  }
}

TEST(UnseenLimbs, AJointIsLostWhereItIsNeitherSeenNorKnown) {
  Extraction seen;
  const auto lost = [&](float visibility, float confidence) {
    seen.visibility[LeftWrist] = visibility, seen.confidence[LeftWrist] = confidence;
    return is_lost(seen, LeftWrist);
  };
  EXPECT_TRUE(lost(0.1f, 0.05f));
  EXPECT_FALSE(lost(0.1f, 0.4f));   // behind the body
  EXPECT_TRUE(lost(0.7f, 0.03f));   // hardly seen where it is said to be
  EXPECT_FALSE(lost(0.7f, 0.15f));  // only badly
  EXPECT_FALSE(lost(1, 0));         // an extractor that knows no visibility
}

TEST(UnseenLimbs, AJointWhoseMirrorImageIsSeenIsKnownLonger) {
  Extraction seen;
  seen.visibility[LeftWrist] = 0, seen.confidence[LeftWrist] = 0.15f;
  EXPECT_FALSE(is_lost(seen, LeftWrist));
  seen.visibility[RightWrist] = 0.4f;
  EXPECT_TRUE(is_lost(seen, LeftWrist));
}

TEST(UnseenLimbs, LegsThatNobodySawStandUnderThePelvis) {
  for (const bool rotations : {true, false}) {
    UnseenLimbs limbs;
    for (int t = 0; t < 90; ++t) {
      Pose pose = dance(0.1f * static_cast<float>(t));
      pose.root.y() = standing().root.y();
      Extraction seen = frame_of(pose, kLegs, t);
      if (!rotations) seen.global.reset();
      const Extraction result = limbs.push(seen, kFrame_s);
      for (const int side : {0, 1}) {
        const Vec3 hip = joint(result, LeftHip + side), ankle = joint(result, LeftAnkle + side);
        EXPECT_LT((hip - ankle).cross(Vec3::UnitY()).norm(), 0.09f) << t;  // right below
        EXPECT_NEAR((joint(result, LeftKnee + side) - hip).norm(), 0.4923f, 0.03f);
      }
      EXPECT_NEAR(lowest_foot(result), 0.03f, 0.035f) << t;  // the pelvis tilts the hips by some cm
      EXPECT_NEAR(result.sole_height.value_or(9), 0, 0.035f);
      for (const int j : {Pelvis, Head, LeftWrist, RightElbow})
        EXPECT_EQ(result.joints.row(j), seen.joints.row(j));
    }
    EXPECT_EQ(limbs.limbs()[2], LimbSight::Unseen);
    EXPECT_EQ(limbs.limbs()[0], LimbSight::Seen);
    EXPECT_EQ(limbs.feet(), (Standing{false, false}));
  }
}

TEST(UnseenLimbs, LegsAreAsLongAsTheSeenBonesOfThePersonSay) {
  UnseenLimbs limbs;
  Extraction seen = frame_of(standing(), kLegs);
  seen.joints *= 0.6f;
  const Extraction result = limbs.push(seen, kFrame_s);
  EXPECT_NEAR(leg_length(result.joints), 0.6f, 0.01f);
}

TEST(UnseenLimbs, LegsThatWereSeenBeforeKeepTheirLength) {
  UnseenLimbs limbs;
  const Joints person = other_body();  // legs shorter than the rest says
  Extraction seen;
  seen.confidence.setConstant(0.9f);
  for (int t = 0; t < 60; ++t) {
    seen.joints = forward_kinematics(person, standing()).joints;
    if (t >= 20)
      for (const int j : kLegs) seen.visibility[j] = seen.confidence[j] = 0;
    seen = limbs.push(seen, kFrame_s);
  }
  EXPECT_NEAR(leg_length(seen.joints), leg_length(person), 0.03f * leg_length(person));
}

/// The largest step of any joint between two frames, seen from the pelvis.
float largest_step(const Joints& a, const Joints& b) {
  return ((a.rowwise() - a.row(Pelvis)) - (b.rowwise() - b.row(Pelvis))).rowwise().norm().maxCoeff();
}

TEST(UnseenLimbs, LimbsGoAndReturnSmoothly) {
  UnseenLimbs limbs;
  Joints last;
  float seen_step = 0, step = 0, distance_after = 1;
  for (int t = 0; t < 120; ++t) {
    const Pose pose = dance(0.05f * static_cast<float>(t));
    const bool lost = t >= 40 && t < 80;
    Extraction seen = frame_of(pose);
    for (const int j : kLegs)
      if (lost) seen.visibility[j] = seen.confidence[j] = 0.1f;
    const Joints result = limbs.push(seen, kFrame_s).joints;
    const Joints before = frame_of(dance(0.05f * static_cast<float>(t - 1))).joints;
    seen_step = std::max(seen_step, largest_step(seen.joints, before));
    if (t > 0) step = std::max(step, largest_step(result, last));
    if (t == 79) EXPECT_EQ(limbs.limbs()[3], LimbSight::Unseen);
    if (t == 79) distance_after = largest_step(result, seen.joints);
    if (t == 110) EXPECT_EQ(result, seen.joints);
    last = result;
  }
  EXPECT_GT(distance_after, 0.3f);  // far from where the legs really were
  EXPECT_LT(step, seen_step + 0.12f);
}

TEST(UnseenLimbs, AMomentUnseenIsNothing) {
  UnseenLimbs limbs;
  for (int t = 0; t < 60; ++t) {
    const Extraction seen =
        frame_of(dance(0.05f * static_cast<float>(t)), t % 10 < 2 ? kLegs : std::vector<int>{}, t);
    if (t < 5) {
      limbs.push(frame_of(dance(0)), kFrame_s);
      continue;
    }
    EXPECT_EQ(limbs.push(seen, kFrame_s).joints, seen.joints) << t;
  }
}

TEST(UnseenLimbs, AnArmOutsideThePictureHangsBesideTheTrunk) {
  UnseenLimbs limbs;
  for (int t = 0; t < 30; ++t) {
    const Extraction seen = frame_of(dance(0.1f * static_cast<float>(t)), kLeftArm, t);
    const Extraction result = limbs.push(seen, kFrame_s);
    const Vec3 arm = joint(result, LeftWrist) - joint(result, LeftShoulder);
    EXPECT_LT(arm.y(), -0.5f);
    EXPECT_LT(Vec3(arm.x(), 0, arm.z()).norm(), 0.25f);
    for (const int j : {RightElbow, RightWrist, LeftKnee, LeftFoot})
      EXPECT_EQ(result.joints.row(j), seen.joints.row(j));
    const Mat3& hand = (*result.global)[LeftWrist];
    EXPECT_NEAR((hand * Vec3::UnitX()).y(), -1, 0.2f);  // the hand hangs along
  }
  EXPECT_EQ(unseen_sentence(limbs.limbs()), "Left arm not seen: it hangs at rest.");
}

TEST(UnseenLimbs, ShinsHangFromKneesThatAreSeen) {
  UnseenLimbs limbs;
  Pose seated;
  seated.root = Vec3(0, 0.67f, 0);
  for (const int side : {0, 1}) {
    seated.local[LeftHip + side] = rotation_from_axis_angle(Vec3(-1.5f, 0, 0));
    seated.local[LeftKnee + side] = rotation_from_axis_angle(Vec3(1.5f, 0, 0));
  }
  const Extraction truth = frame_of(seated), result = limbs.push(frame_of(seated, kShins), kFrame_s);
  EXPECT_LT((result.joints - truth.joints).rowwise().norm().maxCoeff(), 0.05f);
  EXPECT_EQ(limbs.limbs()[2], LimbSight::EndUnseen);
}

TEST(UnseenLimbs, KneesDoNotBendForwards) {
  UnseenLimbs limbs;
  Pose pose = standing();
  pose.local[LeftHip] = rotation_from_axis_angle(Vec3(0.6f, 0, 0));  // the thigh points back
  const Extraction result = limbs.push(frame_of(pose, kShins), kFrame_s);
  const Vec3 thigh = joint(result, LeftKnee) - joint(result, LeftHip),
             shin = joint(result, LeftAnkle) - joint(result, LeftKnee);
  EXPECT_LE(shin.z() / shin.norm(), thigh.z() / thigh.norm() + 0.06f);
}

TEST(UnseenLimbs, APelvisTooLowForItsLegsBendsTheKneesAndFeetStayOnTheFloor) {
  UnseenLimbs limbs;
  for (const float low : {0.1f, 0.3f, 0.5f}) {
    Pose pose = standing();
    pose.root.y() -= low;
    limbs.reset();
    const Extraction result = limbs.push(frame_of(pose, kLegs), kFrame_s);
    EXPECT_NEAR(lowest_foot(result), 0.03f, 0.02f) << low;
    EXPECT_GT(joint(result, LeftKnee).z(), joint(result, LeftAnkle).z() + 0.1f);
    EXPECT_NEAR(leg_length(result.joints), 1, 0.05f);
  }
}

TEST(UnseenLimbs, WhoRisesIsHeldByTheFloorWithinTwoSeconds) {
  UnseenLimbs limbs;
  Extraction result;
  for (int t = 0; t < 120; ++t) {
    Pose pose = standing();
    pose.root.y() += t < 30 ? 0.0f : 0.4f;
    result = limbs.push(frame_of(pose, kLegs, t), kFrame_s);
    if (t == 31) EXPECT_GT(result.sole_height.value_or(0), 0.25f);  // it may be a jump
  }
  EXPECT_NEAR(result.sole_height.value_or(9), 0, 0.03f);
  EXPECT_NEAR(leg_length(result.joints), 1, 0.05f);
}

TEST(UnseenLimbs, WhoLiesHasLegsInLineWithTheBody) {
  UnseenLimbs limbs;
  Pose lying;
  lying.local[Pelvis] = rotation_from_axis_angle(Vec3(-kPi / 2, 0, 0));
  lying.root = Vec3(0, 0.15f, 0);
  const Extraction truth = frame_of(lying), result = limbs.push(frame_of(lying, kLegs), kFrame_s);
  EXPECT_LT((result.joints - truth.joints).rowwise().norm().maxCoeff(), 0.08f);
}

TEST(UnseenLimbs, ASentenceNamesEachPairOnce) {
  using S = LimbSight;
  EXPECT_EQ(unseen_sentence({}), "");
  EXPECT_EQ(unseen_sentence({S::Seen, S::Seen, S::Unseen, S::Unseen}), "Legs not seen: they stand still.");
  EXPECT_EQ(unseen_sentence({S::Unseen, S::EndUnseen, S::EndUnseen, S::EndUnseen}),
            "Lower legs not seen: they stand still. Left arm not seen: it hangs at rest. Right forearm not "
            "seen: it hangs "
            "at rest.");
}

TEST(Refusal, LooksOnlyAtJointsThatAreSeen) {
  Observation seen;
  static_cast<Extraction&>(seen) = frame_of(standing(), kLegs);
  seen.confidence.setConstant(0.1f);
  for (const int j : kLegs) seen.confidence[j] = 0;
  EXPECT_FLOAT_EQ(mean_confidence(seen), 0.1f);
  EXPECT_EQ(refusal(seen), "");
  seen.visibility.setOnes();
  EXPECT_NE(refusal(seen), "");
}

TEST(SoleHeight, IsUnknownWhereTheFeetAreLost) {
  const PointBody body(human_rest());
  Extraction source = frame_of(Pose{});
  ASSERT_TRUE(sole_height(source, body.mesh.vertices));
  for (const int j : kShins) source.visibility[j] = source.confidence[j] = 0;
  EXPECT_FALSE(sole_height(source, body.mesh.vertices));
}

struct HalfPerformance {
  Joints rest = other_body();
  PointBody target{rest};
  Performer performer{prepare_target(target.mesh, rest), std::make_shared<CopyTransfer>(),
                      std::make_shared<RigidDeformer>(target.weights)};
  PerformedFrame perform(const Pose& pose, const std::vector<int>& lost, uint64_t seed) {
    Observation seen;
    static_cast<Extraction&>(seen) = frame_of(pose, lost, seed);
    return performer.perform(seen, kFrame_s);
  }
};

TEST(Performer, LegsThatNobodySawStandStillOnTheFloor) {
  HalfPerformance half;
  for (int t = 0; t < 90; ++t) {
    Pose pose = dance(0.05f * static_cast<float>(t));
    pose.local[Pelvis] = rotation_about_y(0.02f * static_cast<float>(t));
    pose.root.y() = standing().root.y() + 0.01f * std::sin(0.5f * static_cast<float>(t));
    const PerformedFrame frame = half.perform(pose, kLegs, t);
    EXPECT_FALSE(frame.flagged) << frame.reason;
    EXPECT_EQ(frame.standing, (Standing{false, false}));
    EXPECT_EQ(unseen_sentence(frame.limbs), "Legs not seen: they stand still.");
    for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightFoot})
      EXPECT_LT(geodesic_angle(frame.pose.local[j], Mat3::Identity()), 0.1f) << kJointNames[j] << t;
    EXPECT_NEAR(frame.vertices.col(1).minCoeff(), 0, 0.03f) << t;
  }
}

TEST(Performer, WhoseLegsWereNeverSeenWalksAtTheScaleOfWhatIsSeen) {
  HalfPerformance half;
  Vec3 first, last;
  for (int t = 0; t < 60; ++t) {
    Pose pose = standing();
    pose.root.x() += 0.02f * static_cast<float>(t);
    last = half.perform(pose, kLegs, t).pose.root;
    if (t == 0) first = last;
  }
  const float scale = leg_length(half.rest) / 1.0f;
  EXPECT_NEAR((last - first).x() / (59 * 0.02f), scale, 0.02f * scale);
}

}  // namespace
}  // namespace understudy
