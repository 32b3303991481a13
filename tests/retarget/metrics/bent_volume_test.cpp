#include "retarget/metrics/bent_volume.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

Points bent(const ShapedBody& body, int joint, const Mat3& turn) {
  Pose pose;
  pose.root = body.joints.row(Pelvis);
  pose.local[static_cast<size_t>(joint)] = turn;
  return linear_blend_skinning(body.vertices, body.weights, body.joints,
                               forward_kinematics(body.joints, pose));
}

TEST(BentVolume, IsWhatItIs) {
  const ShapedBody body = builtin_person();
  const BentVolume volume(body.vertices, body.faces, body.joints);
  for (size_t bend = 0; bend < BentVolume::kBends.size(); ++bend) {
    EXPECT_NEAR(volume.kept(bend, body.vertices), 1, 1e-5);
    const Points larger = 2 * body.vertices;
    EXPECT_NEAR(volume.kept(bend, larger), 8, 1e-3);
    Points away = body.vertices * rotation_about_y(1.0f).transpose();
    away.rowwise() += Eigen::RowVector3f(3, 1, -2);
    EXPECT_NEAR(volume.kept(bend, away), 1, 1e-3);
  }
}

TEST(BentVolume, PlainSkinningLosesMoreTheFartherItBends) {
  const ShapedBody body = builtin_person();
  const BentVolume volume(body.vertices, body.faces, body.joints);
  const auto kept = [&](size_t bend, float degrees) {
    const Vec3 axis = BentVolume::kBends[bend] == LeftElbow ? Vec3(0, -1, 0) : Vec3(1, 0, 0);
    const Mat3 turn = rotation_from_axis_angle(degrees * kPi / 180 * axis);
    return volume.kept(bend, bent(body, BentVolume::kBends[bend], turn));
  };
  for (const size_t bend : {size_t{0}, size_t{2}}) {
    EXPECT_LT(kept(bend, 120), kept(bend, 60));
    EXPECT_LT(kept(bend, 60), 1);
    EXPECT_GT(kept(bend, 120), 0.4);
  }
  // Another joint's flesh is left alone.
  EXPECT_NEAR(volume.kept(1, bent(body, LeftElbow, rotation_about_y(-2))), 1, 1e-4);
}

TEST(BentVolume, WantsASurface) {
  const ShapedBody body = builtin_person();
  EXPECT_THROW(BentVolume(body.vertices, Faces(0, 3), body.joints), Error);
}

}  // namespace
}  // namespace understudy
