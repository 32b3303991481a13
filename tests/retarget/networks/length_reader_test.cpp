// The shipped weights on the built-in person, whom they have never seen.
#include "retarget/networks/length_reader.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"
#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/proportion_estimate.hpp"

namespace understudy {
namespace {

const LengthReader& shipped() {
  static const auto reader =
      nn::load_network_length_reader(US_SOURCE_DIR "/assets/weights/proportions.weights");
  return *reader;
}

/// Somebody with long arms and short legs walks before a camera.
struct Walk {
  FlatPerson person;
  Motion motion;
  Pinhole camera;
};
Walk walk(float yaw) {
  static const ShapedBody body = builtin_person();
  BoneScales scales;
  scales.arms = 1.3f, scales.legs = 0.75f;
  Walk made{scaled_apart(flat_person(body.vertices, body.joints, head_vertices(body.vertices, body.joints)),
                         scales),
            builtin_motion("walk", body.joints), looking_at(Vec3(0, 0.9f, 0), camera_axes(yaw, 0.1f), 7)};
  made.camera.focal = 1500;
  return made;
}

double ratio_error(const Walk& walk, const DetectorErrors& errors) {
  ProportionEstimate estimate;
  Rng rng(5);
  BoneLengths truth;
  for (size_t t = 0; t < walk.motion.poses.size(); t += walk.motion.poses.size() / 10) {
    const FlatSight sight = seen_flat(walk.person, walk.motion.poses[t], walk.camera);
    const FlatPose pose = detected(sight, errors, rng);
    estimate.push(pose, shipped().read(pose));
    truth = sight.length;
  }
  return bone_ratio_error(estimate.lengths().length, truth);
}

TEST(LengthReader, TellsLongArmsAndShortLegsFromWhereverSomebodyIsSeen) {
  for (const float yaw : {0.0f, 0.8f, 1.6f, 3.0f}) EXPECT_LT(ratio_error(walk(yaw), {}), 10) << yaw;
}

TEST(LengthReader, MissingPointsCostLittle) {
  DetectorErrors errors;
  errors.missing = 0.15f;
  EXPECT_LT(ratio_error(walk(0.8f), errors), 10);
}

TEST(LengthReader, DoubtsMostWhatItDoesNotSee) {
  const Walk somebody = walk(0);
  FlatPose pose = seen_flat(somebody.person, somebody.motion.poses[0], somebody.camera).pose;
  const PoseLengths whole = shipped().read(pose);
  for (const int p : {body25::LeftKnee, body25::RightKnee, body25::LeftAnkle, body25::RightAnkle})
    pose.forget(p);
  EXPECT_GT(shipped().read(pose).doubt[flat_bone::LeftShin], 1.5f * whole.doubt[flat_bone::LeftShin]);
}

TEST(LengthReader, ReadsTheSameTwiceAndRefusesNobody) {
  const Walk somebody = walk(1);
  const FlatPose pose = seen_flat(somebody.person, somebody.motion.poses[3], somebody.camera).pose;
  const PoseLengths one = shipped().read(pose), again = shipped().read(pose);
  EXPECT_TRUE((one.log_length == again.log_length).all() && (one.doubt == again.doubt).all());
  EXPECT_THROW(shipped().read({}), Error);
}

}  // namespace
}  // namespace understudy
