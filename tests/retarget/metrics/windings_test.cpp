// What surfaces wind around, many points at once.

#include <gtest/gtest.h>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/metrics/inside.hpp"

namespace understudy {
namespace {

/// Points in and about the body, some of them within a few millimetres of its skin.
Points points_about(const Points& vertices, const Faces& faces) {
  Rng rng(3);
  const Points normals = vertex_normals(vertices, faces);
  Points points(150, 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const int v = rng.below(static_cast<int>(vertices.rows()));
    points.row(i) = vertices.row(v) + rng.uniform(-0.06f, 0.03f) * normals.row(v);
    if (i % 3 == 0) points.row(i) = vertices.row(v) + rng.uniform(-0.003f, 0.003f) * normals.row(v);
  }
  return points;
}

void expect_agreement(const Windings& windings, const Points& vertices, const Faces& faces) {
  const Points points = points_about(vertices, faces);
  const std::vector<bool> around = windings.around(vertices, points);
  ASSERT_EQ(around.size(), static_cast<size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    EXPECT_EQ(around[static_cast<size_t>(i)],
              winding_number(vertices, faces, points.row(i).transpose()) > 0.5)
        << points.row(i);
}

TEST(Windings, SayWhatEachFaceDoesInAnyPose) {
  const ShapedBody person = builtin_person();
  const Windings windings(person.vertices, person.faces);
  expect_agreement(windings, person.vertices, person.faces);
  const Motion dance = builtin_motion("dance", builtin_joints());
  expect_agreement(windings,
                   linear_blend_skinning(person.vertices, person.weights, person.joints,
                                         forward_kinematics(person.joints, dance.poses[40])),
                   person.faces);
}

TEST(Windings, TakeASurfaceWithHoles) {
  const ShapedBody person = builtin_person();
  const Faces open = person.faces.topRows(person.faces.rows() * 9 / 10);
  expect_agreement(Windings(person.vertices, open), person.vertices, open);
}

TEST(Windings, OfNothingGoAroundNothing) {
  const Points points = Points::Zero(2, 3);
  EXPECT_EQ(Windings(points, Faces(0, 3)).around(points, points), std::vector<bool>(2, false));
}

}  // namespace
}  // namespace understudy
