// What the lifter's network sees, and where the lifted person stands.
#include "retarget/pose2d/lift_input.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/lifted_path.hpp"
#include "tests/support/lifted_walk.hpp"

namespace understudy {
namespace {

constexpr float kDt = 1 / 30.0f;

/// Of who walks.
const BoneLengths& lengths() {
  static const BoneLengths all = lifted_walk(0, 1).lengths;
  return all;
}

TEST(LiftInput, PlaceAndSizeInThePictureChangeNothing) {
  const LiftedWalk walk = lifted_walk(0.5f, 5);
  LiftInput here, there;
  for (const FlatPose& pose : walk.poses) {
    FlatPose moved = pose;
    for (int p = 0; p < kBodyPoints; ++p)
      if (pose.has(p)) moved.set(p, 3 * pose.at(p) + Vec2(500, -80), pose.confidence(p));
    const LiftFrame a = here.push(pose, lengths(), kDt), b = there.push(moved, lengths(), kDt);
    EXPECT_LT((a.numbers - b.numbers).cwiseAbs().maxCoeff(), 2e-3f);
    EXPECT_NEAR(b.size, 3 * a.size, 1e-2f * a.size);
  }
}

TEST(LiftInput, MissingPointsAreZeros) {
  FlatPose pose = lifted_walk(0, 1).poses[0];
  pose.forget(body25::LeftWrist);
  const LiftFrame whole = LiftInput().push(pose, lengths(), kDt);
  EXPECT_TRUE(whole.has_hips && whole.sees_hips);
  EXPECT_TRUE(whole.numbers.segment<kLiftPointInputs>(kLiftPointInputs * body25::LeftWrist).isZero());
}

TEST(LiftInput, HipsThatAreNotSeenAreGuessedBelowTheNeck) {
  const FlatPose pose = lifted_walk(0, 1).poses[0];
  FlatPose cut = pose;
  for (const int p : {body25::MidHip, body25::LeftHip, body25::RightHip}) cut.forget(p);
  const float trunk = (pose.at(body25::MidHip) - pose.at(body25::Neck)).norm();
  const LiftFrame guessed = LiftInput().push(cut, lengths(), kDt);
  EXPECT_TRUE(guessed.has_hips && !guessed.sees_hips);
  EXPECT_LT((guessed.origin - pose.at(body25::MidHip)).norm(), 0.35f * trunk) << "from head and shoulders";
  LiftInput remembers;
  remembers.push(pose, lengths(), kDt);
  EXPECT_LT((remembers.push(cut, lengths(), kDt).origin - pose.at(body25::MidHip)).norm(), 0.01f * trunk);
  cut.forget(body25::Neck), cut.forget(body25::LeftShoulder), cut.forget(body25::RightShoulder);
  EXPECT_FALSE(LiftInput().push(cut, lengths(), kDt).has_hips) << "nothing to hang them on";
}

TEST(LiftInput, WaysAreThoseOfAThirtiethOfASecond) {
  const LiftedWalk walk = lifted_walk(0.5f, 3);
  LiftInput fast, slow;
  fast.push(walk.poses[0], lengths(), kDt), slow.push(walk.poses[0], lengths(), 2 * kDt);
  const LiftFrame a = fast.push(walk.poses[1], lengths(), kDt),
                  b = slow.push(walk.poses[1], lengths(), 2 * kDt);
  const int way = kLiftPointInputs * body25::LeftAnkle + 4;
  EXPECT_GT(a.numbers.segment<2>(way).norm(), 1e-3f);
  EXPECT_NEAR(a.numbers[way], 2 * b.numbers[way], 1e-3f);
}

TEST(LiftInput, BonesThatLookShortGoIntoDepth) {
  const auto depth_of = [](const FlatPose& pose, int bone) {
    return LiftInput().push(pose, lengths(), kDt).numbers[kLiftBonesAt + kLiftBoneInputs * bone + 1];
  };
  FlatPose pose = lifted_walk(0, 1).poses[0];
  const Vec2 elbow = pose.at(body25::LeftElbow);
  const float length = lengths()[flat_bone::LeftForearm] / lengths()[flat_bone::LeftThigh] *
                       (pose.at(body25::LeftKnee) - pose.at(body25::LeftHip)).norm();
  pose.set(body25::LeftWrist, elbow + Vec2(length, 0), 1);
  const float across = depth_of(pose, flat_bone::LeftForearm);
  pose.set(body25::LeftWrist, elbow + Vec2(0.3f * length, 0), 1);
  const float towards = depth_of(pose, flat_bone::LeftForearm);
  EXPECT_GT(towards, 2 * across);
  const LiftFrame frame = LiftInput().push(pose, lengths(), kDt);
  EXPECT_NEAR(towards, kLiftPlaceScale * 0.95f * length / frame.size, 0.15f * towards);
  BoneLengths longer = 2 * lengths();
  EXPECT_LT((LiftInput().push(pose, longer, kDt).numbers - frame.numbers).cwiseAbs().maxCoeff(), 1e-5f)
      << "only what lengths are of each other counts";
  longer[0] = 0;
  EXPECT_THROW(LiftInput().push(pose, longer, kDt), Error);
}

TEST(LiftInput, RefusesWhatNobodyCouldLift) {
  FlatPose pose = lifted_walk(0, 1).poses[0];
  EXPECT_THROW(LiftInput().push(pose, lengths(), 0), Error);
  EXPECT_THROW(LiftInput().push({}, lengths(), kDt), Error);
  pose.set(body25::Nose, Vec2(std::nanf(""), 3), 1);
  EXPECT_THROW(LiftInput().push(pose, lengths(), kDt), Error);
  FlatPose point;
  for (const int p : {0, 1, 2, 3}) point.set(p, Vec2(7, 7), 1);
  EXPECT_THROW(LiftInput().push(point, lengths(), kDt), Error);
}

TEST(LiftTruth, OfWhoeverStandsAsideIsThatOfACameraTurnedToThem) {
  const ShapedBody body = builtin_person();
  Pose pose;
  pose.root = Vec3(1.5f, 1, 0);
  const PosedSkeleton posed = forward_kinematics(body.joints, pose);
  Pinhole aside = looking_at(Vec3(0, 1, 0), camera_axes(0, 0), 5);
  const LiftTruth truth = lift_truth(posed, aside);
  const Vec3 way = (aside.position - hips_middle(posed.joints)).normalized();
  const Vec3 seen = truth.turns[Pelvis].transpose() * Vec3::UnitZ();  // to the eye, in the pelvis' frame
  EXPECT_LT((seen - way).norm(), 1e-4f);
  EXPECT_NEAR(hips_middle(truth.joints).norm(), 0, 1e-5f);
}

/// A person as they are lifted, without an error.
LiftedPose perfect(const LiftTruth& truth, const FlatPose& pose) {
  LiftedPose lifted;
  lifted.size = 300;
  lifted.joints = truth.joints * (truth.pixels_a_metre / lifted.size);
  lifted.origin = pose.at(body25::MidHip);
  return lifted;
}

LiftView view_of_walk() {
  LiftView view;
  view.canvas = {720, 720};
  view.fov_deg = 2 * std::atan(360 / 1500.0f) * 180 / kPi;
  static const ShapedBody body = builtin_person();
  view.stature_m = stature_of(body.joints);
  return view;
}

TEST(LiftedPath, WhoIsLiftedWithoutErrorWalksAsInTheWorld) {
  for (const float yaw : {0.0f, 1.57f, 2.5f}) {
    const LiftedWalk walk = lifted_walk(yaw);
    LiftedPath path(view_of_walk());
    Joints first, last;
    for (size_t t = 0; t < walk.poses.size(); ++t) {
      last = path.push(perfect(walk.truth[t], walk.poses[t]), walk.poses[t], walk.dt).joints;
      if (t == 0) first = last;
      EXPECT_NEAR(last.col(1).minCoeff(), 0.02f, 0.08f) << "the floor, frame " << t;
    }
    const auto way = [](const Joints& a, const Joints& b) {
      return Vec3((b.row(Pelvis) - a.row(Pelvis)).transpose());
    };
    const ShapedBody body = builtin_person();
    const Motion motion = builtin_motion("walk", body.joints);
    const Vec3 truth =
        camera_axes(yaw, 0).transpose() * (motion.poses[walk.poses.size() - 1].root - motion.poses[0].root);
    EXPECT_NEAR(way(first, last).x(), truth.x(), 0.1f + 0.1f * std::abs(truth.x()));
    EXPECT_NEAR(way(first, last).z(), truth.z(), 0.15f + 0.35f * std::abs(truth.z())) << yaw;
  }
}

TEST(LiftedPath, StandsUprightBeforeACameraThatLooksDown) {
  for (const float pitch : {0.3f, -0.3f}) {
    const LiftedWalk walk = lifted_walk(0.4f, 20, pitch);
    LiftView told = view_of_walk();
    told.pitch_deg = pitch * 180 / kPi;
    LiftedPath by_user(told), by_network(view_of_walk());
    for (size_t t = 0; t < walk.poses.size(); ++t) {
      LiftedPose lifted = perfect(walk.truth[t], walk.poses[t]);
      const Joints a = by_user.push(lifted, walk.poses[t], walk.dt).joints;
      lifted.pitch = std::sin(pitch);
      const Joints b = by_network.push(lifted, walk.poses[t], walk.dt).joints;
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-3f);
      const Vec3 trunk = (a.row(Neck) - a.row(Pelvis)).transpose().normalized();
      EXPECT_GT(trunk.y(), std::cos(0.15f)) << pitch << ", frame " << t;
    }
  }
}

TEST(LiftedPath, TellsWhatIsSeenAndHowSureItIs) {
  const LiftedWalk walk = lifted_walk(0.3f, 1);
  FlatPose pose = walk.poses[0];
  LiftedPose lifted = perfect(walk.truth[0], pose);
  lifted.off[LeftWrist] = 0.2f;
  for (const int p : {body25::LeftWrist, body25::LeftElbow}) pose.forget(p);
  const Extraction out = LiftedPath(view_of_walk()).push(lifted, pose, walk.dt);
  EXPECT_EQ(out.visibility[LeftWrist], 0);
  EXPECT_EQ(out.visibility[RightWrist], 1);
  EXPECT_LT(out.confidence[LeftWrist], 0.5f);
  EXPECT_GT(out.confidence[RightWrist], 0.9f);
  EXPECT_FALSE(out.exact);
}

TEST(LiftedPath, RefusesViewsOfNobody) {
  LiftView view;
  EXPECT_THROW(LiftedPath{view}, Error);
  view.canvas = {640, 480};
  view.stature_m = 9;
  EXPECT_THROW(LiftedPath{view}, Error);
  view.stature_m = 1.7f;
  view.fov_deg = 180;
  EXPECT_THROW(LiftedPath{view}, Error);
  view.fov_deg = 50;
  view.pitch_deg = 90;
  EXPECT_THROW(LiftedPath{view}, Error);
}

}  // namespace
}  // namespace understudy
