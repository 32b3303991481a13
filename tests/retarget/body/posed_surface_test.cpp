#include "retarget/body/posed_surface.hpp"

#include <gtest/gtest.h>

#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

TEST(HandMotion, StaysOrGoesOnFromFrameToFrame) {
  HandMotion still;
  still.from[0].setConstant(20);
  still.to = still.from;
  EXPECT_EQ(still.next(), still.next());
  HandMotion closing;
  closing.to[1].setConstant(50);
  closing.share = 0.5f;
  closing.step = 0.1f;
  EXPECT_NEAR(closing.next()[1][3], 25, 1e-4f);
  EXPECT_NEAR(closing.next()[1][3], 30, 1e-4f);
  for (int i = 0; i < 20; ++i) closing.next();
  EXPECT_NEAR(closing.next()[1][3], 50, 1e-4f);
  EXPECT_EQ(closing.next()[0][3], 0);
}

TEST(PosedSurface, PointsLieOnThePosedBodyAndNormalsPointOut) {
  const ShapedBody body = builtin_person();
  Pose pose;
  pose.root = Vec3(0.3f, 0.9f, 0.1f);
  pose.local[LeftElbow] = rotation_from_axis_angle(Vec3(0, -1.2f, 0));
  pose.local[RightKnee] = rotation_from_axis_angle(Vec3(0.8f, 0, 0));
  PosedSurface surface(body, pose, {});
  Rng rng(2);
  const SurfaceSampler sampler(body.vertices, body.faces);
  const OrientedPoints cloud = surface.sample(sampler, body.faces, 4000, rng);
  const Points vertices = posed_vertices(body, pose), normals = vertex_normals(vertices, body.faces);
  const IntMatrix nearest = nearest_neighbours(vertices, cloud.points, 1);
  int outwards = 0;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    EXPECT_LT((cloud.points.row(i) - vertices.row(nearest(i, 0))).norm(), 0.03f);
    outwards += cloud.normals.row(i).dot(normals.row(nearest(i, 0))) > 0.5f;
  }
  EXPECT_GT(outwards, 3900);
  EXPECT_EQ(surface.truth().joints, forward_kinematics(body.joints, pose).joints);
}

TEST(PosedSurface, AHandsSolidIsThatHand) {
  const ShapedBody body = builtin_person();
  const Pose pose;
  PosedSurface surface(body, pose, {});
  for (int side = 0; side < 2; ++side) {
    const auto solid = surface.hand_solid(side, 1100, 0.008f, 5);
    ASSERT_TRUE(solid);
    Vec3 palm = Vec3::Zero();
    int count = 0;
    for (Eigen::Index v = 0; v < body.vertices.rows(); ++v)
      if (body.weights(v, LeftWrist + side) > 0.9f) palm += body.vertices.row(v).transpose(), ++count;
    palm /= static_cast<float>(count);
    palm = 0.5f * palm + 0.5f * body.joints.row(LeftWrist + side).transpose();
    EXPECT_GT(solid->at(palm).inside, 0.5f);
    EXPECT_LT(solid->at(palm + Vec3(0, 0.1f, 0)).inside, 0.1f);
    EXPECT_LT(solid->at(body.joints.row(LeftWrist + 1 - side).transpose()).inside, 0.1f);
  }
}

}  // namespace
}  // namespace understudy
