// References that nobody would choose: what the shipped weights read off one picture of them.
#include <gtest/gtest.h>

#include "retarget/base/text.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"
#include "retarget/networks/length_reader.hpp"
#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/limb_transfer.hpp"
#include "retarget/pose2d/proportion_estimate.hpp"
#include "retarget/pose2d/reference_remarks.hpp"

namespace understudy {
namespace {

const LengthReader& shipped_reader() {
  static const auto reader =
      nn::load_network_length_reader(US_SOURCE_DIR "/assets/weights/proportions.weights");
  return *reader;
}

const FlatPerson& somebody() {
  static const FlatPerson person = [] {
    const ShapedBody body = builtin_person();
    return flat_person(body.vertices, body.joints, head_vertices(body.vertices, body.joints));
  }();
  return person;
}

/// Arms hang, a little bent.
Pose relaxed() {
  Pose pose;
  pose.local[LeftShoulder] = rotation_from_axis_angle(Vec3(0, 0, -1.2f));
  pose.local[RightShoulder] = rotation_from_axis_angle(Vec3(0, 0, 1.2f));
  pose.local[LeftElbow] = rotation_from_axis_angle(Vec3(0, -0.3f, 0));
  pose.local[RightElbow] = rotation_from_axis_angle(Vec3(0, 0.3f, 0));
  return pose;
}

Pose seated() {
  Pose pose = relaxed();
  for (const int hip : {LeftHip, RightHip}) pose.local[hip] = rotation_from_axis_angle(Vec3(-1.5f, 0, 0));
  for (const int knee : {LeftKnee, RightKnee}) pose.local[knee] = rotation_from_axis_angle(Vec3(1.5f, 0, 0));
  return pose;
}

FlatSight sight_of(const FlatPerson& person, const Pose& pose, float yaw) {
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(yaw, 0.05f), 5);
  camera.focal = 1000, camera.centre = {360, 360};
  return seen_flat(person, pose, camera);
}

/// As one picture tells.
Proportions read_off(const FlatPose& pose) {
  ProportionEstimate estimate;
  estimate.push(pose, shipped_reader().read(pose));
  return estimate.lengths();
}

double length_error(const FlatPose& pose, const FlatSight& truth) {
  return bone_ratio_error(read_off(pose).length, truth.length);
}

std::string remarks_on(const FlatPose& pose) {
  std::string all;
  for (const std::string& remark : reference_remarks(pose, read_off(pose))) append_item(all, remark, "; ");
  return all;
}

/// A pose of somebody else performed with what was read: no bone is out of all proportion to the truth.
void expect_sane(const FlatPose& reference, const FlatSight& truth) {
  const FlatSight source = sight_of(somebody(), relaxed(), 0.3f);
  Proportions from;
  from.length = source.length;
  const FlatPose made = LimbTransfer().transfer(source.pose, from, read_off(reference));
  const BoneLengths looks = seen_lengths(made), sources = seen_lengths(source.pose);
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const float wanted = sources[b] * truth.length[b] / source.length[b];
    EXPECT_LT(looks[b], 2 * wanted) << kFlatBones[static_cast<size_t>(b)].name;
    EXPECT_GT(looks[b], wanted / 2) << kFlatBones[static_cast<size_t>(b)].name;
  }
}

TEST(OddReferences, FromBehindLengthsAreAsGoodAndItIsTold) {
  FlatSight sight = sight_of(somebody(), relaxed(), kPi);
  for (const int point : {body25::Nose, body25::RightEye, body25::LeftEye}) sight.pose.forget(point);
  EXPECT_LT(length_error(sight.pose, sight), 12);
  EXPECT_NE(remarks_on(sight.pose).find("is seen from behind"), std::string::npos) << remarks_on(sight.pose);
  expect_sane(sight.pose, sight);
}

TEST(OddReferences, OfWhoSitsLengthsAreNearTheTruth) {
  for (const float yaw : {0.0f, 0.6f, 1.5f}) {
    const FlatSight sight = sight_of(somebody(), seated(), yaw);
    EXPECT_LT(length_error(sight.pose, sight), 15) << yaw;
    EXPECT_NE(remarks_on(sight.pose).find("sits"), std::string::npos) << yaw << remarks_on(sight.pose);
    expect_sane(sight.pose, sight);
  }
}

TEST(OddReferences, LegsThatAreNotSeenAreGuessed) {
  FlatSight sight = sight_of(somebody(), relaxed(), 0.2f);
  for (const int point : {body25::RightKnee, body25::LeftKnee, body25::RightAnkle, body25::LeftAnkle,
                          body25::RightHeel, body25::LeftHeel, body25::RightBigToe, body25::LeftBigToe,
                          body25::RightSmallToe, body25::LeftSmallToe})
    sight.pose.forget(point);
  EXPECT_LT(length_error(sight.pose, sight), 15);
  EXPECT_GT(read_off(sight.pose).doubt[flat_bone::LeftShin], read_off(sight.pose).doubt[flat_bone::Trunk]);
  EXPECT_NE(remarks_on(sight.pose).find("shows no legs"), std::string::npos);
  expect_sane(sight.pose, sight);
  for (const int point : {body25::MidHip, body25::RightHip, body25::LeftHip}) sight.pose.forget(point);
  expect_sane(sight.pose, sight);  // a bust
}

TEST(OddReferences, UpsideDownLengthsAreThoseOfThePictureTurned) {
  const FlatSight sight = sight_of(somebody(), relaxed(), 0.2f);
  const FlatPose turned = turned_by_half(sight.pose);
  EXPECT_NEAR(length_error(turned, sight), length_error(sight.pose, sight), 0.01);
  EXPECT_NE(remarks_on(turned).find("is upside down"), std::string::npos);
  expect_sane(turned, sight);
}

TEST(OddReferences, ABabyHasABigHeadAndShortLegs) {
  BoneScales scales;
  scales.head = 2.2f, scales.legs = 0.6f, scales.arms = 0.7f, scales.size = 0.4f;
  const FlatPerson baby = scaled_apart(somebody(), scales);
  const FlatSight sight = sight_of(baby, relaxed(), 0.2f);
  EXPECT_LT(length_error(sight.pose, sight), 20);
  const Proportions read = read_off(sight.pose), usual = read_off(sight_of(somebody(), relaxed(), 0.2f).pose);
  EXPECT_GT(read.length[flat_bone::Head] / read.length[flat_bone::LeftThigh],
            2 * usual.length[flat_bone::Head] / usual.length[flat_bone::LeftThigh]);
  expect_sane(sight.pose, sight);
}

TEST(OddReferences, OfADogSomethingFiniteComesAndItIsDoubted) {
  Pose pose;  // on hands and feet
  pose.local[Pelvis] = rotation_from_axis_angle(Vec3(kPi / 2, 0, 0));
  for (const int hip : {LeftHip, RightHip}) pose.local[hip] = rotation_from_axis_angle(Vec3(-1.6f, 0, 0));
  pose.local[LeftShoulder] = rotation_from_axis_angle(Vec3(0, -1.5f, 0));
  pose.local[RightShoulder] = rotation_from_axis_angle(Vec3(0, 1.5f, 0));
  BoneScales scales;
  scales.legs = 0.45f, scales.arms = 0.8f, scales.head = 1.6f, scales.shoulders = 0.3f, scales.hips = 0.4f;
  const FlatSight sight = sight_of(scaled_apart(somebody(), scales), pose, kPi / 2);
  EXPECT_TRUE(read_off(sight.pose).length.allFinite());
  EXPECT_NE(remarks_on(sight.pose).find("if that is no person"), std::string::npos) << remarks_on(sight.pose);
}

}  // namespace
}  // namespace understudy
