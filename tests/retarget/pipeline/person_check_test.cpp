#include "retarget/pipeline/observer.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

/// Legs as long as a cat's are of its trunk, a neck that reaches far, arms short.
Joints four_legged() {
  auto lengths = bone_lengths(human_rest());
  for (const int j : {LeftKnee, RightKnee, LeftAnkle, RightAnkle}) lengths[j] *= 0.45f;
  for (const int j : {Spine1, Spine2, Spine3}) lengths[j] *= 1.6f;
  for (const int j : {Neck, Head, LeftFoot, RightFoot}) lengths[j] *= 1.8f;
  return rest_with_lengths(human_rest(), lengths);
}

Extraction seen(const Joints& joints, float confidence = 0.9f) {
  Extraction extraction;
  extraction.joints = joints;
  extraction.confidence.setConstant(confidence);
  return extraction;
}

TEST(PersonCheck, PeopleOfAnySizeInAnyPoseAreNotDoubted) {
  for (const Joints& body : {human_rest(), fixtures::other_body(), Joints(0.5f * human_rest())}) {
    EXPECT_LT(bone_implausibility(body), 0.2f);
    PersonCheck person;
    for (int t = 0; t < 20; ++t) {
      Pose pose = fixtures::dance(0.3f * static_cast<float>(t));
      pose.local[Pelvis] = rotation_from_axis_angle(Vec3(1.5f, 0, 0));  // on all fours
      EXPECT_EQ(person.push(seen(forward_kinematics(body, pose).joints)), "");
    }
  }
}

TEST(PersonCheck, BonesThatAreNobodysAreToldOnce) {
  EXPECT_GT(bone_implausibility(four_legged()), 0.25f);
  PersonCheck person;
  int told = 0;
  for (int t = 0; t < 10; ++t) {
    const std::string sentence = person.push(seen(four_legged()));
    told += sentence.empty() ? 0 : 1;
    if (!sentence.empty()) EXPECT_EQ(sentence.rfind("may not be a person", 0), 0u) << sentence;
  }
  EXPECT_EQ(told, 1);
}

TEST(PersonCheck, ABadFrameAmongGoodOnesIsNoReason) {
  PersonCheck person;
  for (int t = 0; t < 60; ++t) EXPECT_EQ(person.push(seen(t % 3 ? human_rest() : four_legged())), "") << t;
}

TEST(PersonCheck, AGivenSkeletonIsNotDoubted) {
  PersonCheck person;
  Extraction given = seen(four_legged());
  given.exact = true;
  for (int t = 0; t < 10; ++t) EXPECT_EQ(person.push(given), "");
}

}  // namespace
}  // namespace understudy
