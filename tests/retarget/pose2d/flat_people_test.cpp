#include "retarget/pose2d/flat_people.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

const FlatPerson& somebody() {
  static const FlatPerson person = [] {
    const ShapedBody body = builtin_person();
    return flat_person(body.vertices, body.joints, head_vertices(body.vertices, body.joints));
  }();
  return person;
}

Pinhole front(bool orthographic, float distance = 5) {
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(0, 0), distance);
  camera.focal = orthographic ? 200.0f : 1000.0f;
  camera.centre = {360, 360};
  camera.orthographic = orthographic;
  return camera;
}

Pose some_pose(uint64_t seed) {
  Rng rng(seed);
  Pose pose;
  for (Mat3& local : pose.local) {
    const float x = rng.normal(), y = rng.normal(), z = rng.normal();
    local = rotation_from_axis_angle(0.4f * Vec3(x, y, z));
  }
  return pose;
}

TEST(HeadVertices, NoseIsForemostAndLeftEyeAndEarAreLeft) {
  const HeadPlaces head = somebody().head;
  const Vec3 joint = somebody().rest.row(Head).transpose();
  EXPECT_NEAR(head(0, 0), 0, 0.005f);
  EXPECT_GT(head(0, 2), joint.z() + 0.05f);
  EXPECT_GT(head(2, 0), 0.01f);              // left eye
  EXPECT_LT(head(1, 0), -0.01f);             // right eye
  EXPECT_GT(head(1, 1), head(0, 1));         // above the nose
  EXPECT_GT(head(4, 0), 1.5f * head(2, 0));  // left ear
  EXPECT_LT(head(4, 2), head(2, 2));
  EXPECT_THROW(head_vertices(Points::Zero(4, 3), somebody().rest), Error);
}

TEST(FlatPeople, WhoFacesTheCameraHasTheLeftOnTheRight) {
  const FlatSight sight = seen_flat(somebody(), {}, front(false));
  EXPECT_GT(sight.pose.at(body25::LeftWrist).x(), sight.pose.at(body25::RightWrist).x() + 50);
  EXPECT_LT(sight.pose.at(body25::Nose).y(), sight.pose.at(body25::MidHip).y());
  EXPECT_GT(sight.facing, 0.95f);
  EXPECT_EQ(points_seen(sight.pose), kBodyPoints);
  Pinhole behind = front(false);
  behind = looking_at(Vec3::Zero(), camera_axes(kPi, 0), 5);
  EXPECT_LT(seen_flat(somebody(), {}, behind).facing, -0.95f);
}

TEST(FlatPeople, NeckAndMidHipAreMiddles) {
  const FlatPose pose = seen_flat(somebody(), some_pose(2), front(true)).pose;
  EXPECT_LT(
      (pose.at(body25::Neck) - (pose.at(body25::LeftShoulder) + pose.at(body25::RightShoulder)) / 2).norm(),
      1e-3f);
  EXPECT_LT((pose.at(body25::MidHip) - (pose.at(body25::LeftHip) + pose.at(body25::RightHip)) / 2).norm(),
            1e-3f);
}

TEST(FlatPeople, BonesAcrossTheViewLookAsLongAsTheyAre) {
  const FlatSight sight = seen_flat(somebody(), {}, front(true));
  const BoneLengths looks = seen_lengths(sight.pose);
  for (const int bone :
       {flat_bone::LeftShoulder, flat_bone::RightUpperArm, flat_bone::LeftForearm, flat_bone::RightHip})
    EXPECT_NEAR(looks[bone], sight.length[bone], 0.01f * sight.length[bone])
        << kFlatBones[static_cast<size_t>(bone)].name;
  // In perspective too: arms spread out lie about as far away as the hips.
  const FlatSight near = seen_flat(somebody(), {}, front(false));
  EXPECT_NEAR(seen_lengths(near.pose)[flat_bone::LeftForearm], near.length[flat_bone::LeftForearm],
              0.03f * near.length[flat_bone::LeftForearm]);
  EXPECT_NEAR(near.pixels_a_metre, 200, 2);
}

TEST(FlatPeople, NoLimbLooksLongerThanItIsWithoutPerspective) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const FlatSight sight = seen_flat(somebody(), some_pose(seed), front(true));
    const BoneLengths looks = seen_lengths(sight.pose);
    for (const int bone :
         {flat_bone::LeftUpperArm, flat_bone::RightForearm, flat_bone::LeftThigh, flat_bone::RightShin})
      EXPECT_LE(looks[bone], sight.length[bone] * 1.001f);
  }
}

TEST(FlatPeople, ScaledApartEveryBoneIsSoManyTimesAsLong) {
  BoneScales scales;
  scales.legs = 0.6f, scales.arms = 1.4f, scales.trunk = 0.8f, scales.head = 1.7f;
  scales.shoulders = 1.3f, scales.hips = 0.75f, scales.size = 1.1f;
  const BoneLengths ratio = lengths_of(scaled_apart(somebody(), scales)) / lengths_of(somebody());
  const auto expect = [&](std::initializer_list<int> bones, float scale) {
    for (const int bone : bones) EXPECT_NEAR(ratio[bone], 1.1f * scale, 1e-3f) << bone;
  };
  expect({flat_bone::LeftThigh, flat_bone::RightShin}, 0.6f);
  expect({flat_bone::LeftUpperArm, flat_bone::RightForearm}, 1.4f);
  expect({flat_bone::Trunk}, 0.8f);
  expect({flat_bone::Head}, 1.7f);
  expect({flat_bone::LeftShoulder, flat_bone::RightShoulder}, 1.3f);
  expect({flat_bone::LeftHip, flat_bone::RightHip}, 0.75f);
}

TEST(FlatPeople, AMirroredPoseIsTheMirroredPicture) {
  const Pinhole camera = [] {
    Pinhole centred = front(true);
    centred.centre = {0, 0};
    return centred;
  }();
  const Pose pose = some_pose(5);
  const FlatPose one = in_mirror(seen_flat(somebody(), pose, camera).pose),
                 other = seen_flat(somebody(), mirrored(pose), camera).pose;
  EXPECT_LT((one.body - other.body).cwiseAbs().maxCoeff(), 1.0f);  // a face is not quite symmetric
}

TEST(FlatPeople, NobodyStandsInTheCamera) {
  EXPECT_THROW(seen_flat(somebody(), {}, front(false, 0.05f)), Error);
}

TEST(FlatPeople, ScalesStayInTheirRangesAndViewsInTheirs) {
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    const BoneScales scales = random_scales(rng);
    EXPECT_TRUE(scales.legs >= 0.55f && scales.legs <= 1.35f && scales.head >= 0.7f && scales.head <= 1.8f);
    const Vec3 target(1, 1, -2);
    const Pinhole camera = random_view(target, {}, rng);
    const Vec3 seen = camera.project(target);
    EXPECT_LT((seen.head<2>() - Vec2(360, 360)).norm(), 0.1f);
    EXPECT_TRUE(seen.z() > 2.99f && seen.z() < 10.01f);
  }
}

TEST(Detected, WithoutErrorsIsWhatIsThere) {
  Rng rng(1);
  const FlatSight sight = seen_flat(somebody(), some_pose(3), front(false));
  EXPECT_EQ(detected(sight, {}, rng), sight.pose);
}

TEST(Detected, IsTheSameForTheSameSeed) {
  const FlatSight sight = seen_flat(somebody(), some_pose(3), front(false));
  const auto made = [&](uint64_t seed) {
    Rng rng(seed);
    const DetectorErrors errors = random_errors(rng);
    return detected(sight, errors, rng);
  };
  int differ = 0;
  for (uint64_t seed = 1; seed < 20; ++seed) {
    EXPECT_EQ(made(seed), made(seed));
    differ += made(seed) != made(seed + 1) ? 1 : 0;
  }
  EXPECT_GT(differ, 10);
}

TEST(Detected, JittersByMetresAndByCocosDeviations) {
  const FlatSight sight = seen_flat(somebody(), {}, front(true));
  Rng rng(4);
  DetectorErrors metres, coco;
  metres.jitter_m = 0.015f;
  coco.jitter = 0.2f;
  double squares = 0, nose = 0, hip = 0;
  constexpr int kTimes = 400;
  for (int i = 0; i < kTimes; ++i) {
    const FlatPose off = detected(sight, metres, rng), coarse = detected(sight, coco, rng);
    squares +=
        static_cast<double>((off.at(body25::LeftKnee) - sight.pose.at(body25::LeftKnee)).squaredNorm());
    nose += static_cast<double>((coarse.at(body25::Nose) - sight.pose.at(body25::Nose)).norm());
    hip += static_cast<double>((coarse.at(body25::LeftHip) - sight.pose.at(body25::LeftHip)).norm());
  }
  EXPECT_NEAR(std::sqrt(squares / (2 * kTimes)), 0.015 * 200, 0.2);
  EXPECT_NEAR(hip / nose, 0.107 / 0.026, 0.6);
}

TEST(Detected, LosesPointsLimbsAndWhatThePictureDoesNotShow) {
  const FlatSight sight = seen_flat(somebody(), {}, front(false));
  Rng rng(6);
  DetectorErrors points, limbs, cut;
  points.missing = 0.2f;
  limbs.limbs_missing = 0.5f;
  cut.cut = Cut::Hips;
  int left = 0, halves = 0;
  for (int i = 0; i < 200; ++i) {
    left += points_seen(detected(sight, points, rng));
    const FlatPose pose = detected(sight, limbs, rng);
    halves += pose.has(body25::LeftElbow) != pose.has(body25::LeftWrist) ? 1 : 0;
  }
  EXPECT_NEAR(left / (200.0 * kBodyPoints), 0.8, 0.03);
  EXPECT_EQ(halves, 0);
  const FlatPose above = detected(sight, cut, rng);
  EXPECT_TRUE(above.has(body25::LeftHip));
  for (const int gone : {body25::LeftKnee, body25::RightAnkle, body25::LeftHeel})
    EXPECT_FALSE(above.has(gone));
  DetectorErrors all;
  all.missing = 1;
  EXPECT_GE(points_seen(detected(sight, all, rng)), 4);
}

TEST(Detected, ExchangesSidesAndHidesTheFaceOfWhoLooksAway) {
  Rng rng(7);
  const FlatSight sight = seen_flat(somebody(), {}, front(false));
  DetectorErrors errors;
  errors.exchanged = 1;
  errors.hides_face = true;
  EXPECT_EQ(detected(sight, errors, rng), sides_exchanged(sight.pose));  // a face that is seen stays
  const FlatSight back = seen_flat(somebody(), {}, looking_at(Vec3::Zero(), camera_axes(kPi, 0), 5));
  const FlatPose away = detected(back, errors, rng);
  EXPECT_FALSE(away.has(body25::Nose));
  EXPECT_TRUE(away.has(body25::LeftEar));
}

TEST(Detected, HonestConfidenceFallsWithTheErrorAndWrongOneDoesNot) {
  const FlatSight sight = seen_flat(somebody(), {}, front(true));
  const auto correlation = [&](DetectorErrors::Confidence kind) {
    Rng rng(9);
    DetectorErrors errors;
    errors.jitter = 0.8f;
    errors.confidence = kind;
    double sum = 0, x_sum = 0, y_sum = 0, xx = 0, yy = 0, n = 0;
    for (int i = 0; i < 200; ++i) {
      const FlatPose pose = detected(sight, errors, rng);
      for (const int p : {body25::LeftKnee, body25::RightElbow}) {
        const double x = static_cast<double>((pose.at(p) - sight.pose.at(p)).norm()),
                     y = static_cast<double>(pose.confidence(p));
        sum += x * y, x_sum += x, y_sum += y, xx += x * x, yy += y * y, ++n;
      }
    }
    return (sum - x_sum * y_sum / n) / std::sqrt((xx - x_sum * x_sum / n) * (yy - y_sum * y_sum / n));
  };
  EXPECT_LT(correlation(DetectorErrors::Confidence::Honest), -0.3);
  EXPECT_NEAR(correlation(DetectorErrors::Confidence::Wrong), 0, 0.15);
}

}  // namespace
}  // namespace understudy
