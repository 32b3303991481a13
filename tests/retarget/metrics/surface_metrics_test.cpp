// Surface metrics against values worked out by hand.
#include "retarget/metrics/surface_metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/inside.hpp"

namespace understudy {
namespace {

/// A line of `count` points 10 mm apart.
Points line(int count) {
  Points x = Points::Zero(count, 3);
  for (int i = 0; i < count; ++i) x(i, 0) = 0.01f * static_cast<float>(i);
  return x;
}

Points random_points(int count, uint64_t seed) {
  Rng rng(seed);
  Points x(count, 3);
  for (int i = 0; i < count; ++i) x.row(i) << rng.uniform(), rng.uniform(), rng.uniform();
  return x;
}

/// A closed box, triangles counter-clockwise from outside.
Mesh box(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  mesh.vertices.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.row(i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
  mesh.faces.resize(12, 3);
  mesh.faces << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1,
      3, 5, 3, 7, 5;
  return mesh;
}

Mesh together(const Mesh& a, const Mesh& b) {
  Mesh mesh;
  mesh.vertices.resize(a.vertices.rows() + b.vertices.rows(), 3);
  mesh.vertices << a.vertices, b.vertices;
  mesh.faces.resize(a.faces.rows() + b.faces.rows(), 3);
  mesh.faces << a.faces, b.faces.array() + static_cast<int>(a.vertices.rows());
  return mesh;
}

/// Points on the surface of a cylinder round the y axis, 1 m long, closed at both ends.
Points limb(float radius, int count) {
  Rng rng(3);
  Points x(count, 3);
  for (int i = 0; i < count; ++i) {
    const float angle = rng.uniform(0, 2 * kPi);
    const bool cap = i % 10 == 0;
    const float r = cap ? radius * std::sqrt(rng.uniform()) : radius;
    x.row(i) << r * std::cos(angle), cap ? static_cast<float>(i % 20 == 0) : rng.uniform(),
        r * std::sin(angle);
  }
  return x;
}

TEST(ChamferDistance, IsTheMeanOfBothWays) {
  Points p(2, 3), q(3, 3);
  p << 0, 0, 0, 1, 0, 0;
  q << 0, 0.2f, 0, 0, 0, 0.4f, 1, 0, 0;
  // from p: 0.2, 0; from q: 0.2, 0.4, 0
  EXPECT_NEAR(chamfer_distance(p, q), (0.1 + 0.2) / 2, 1e-6);
  EXPECT_NEAR(chamfer_distance(q, p), (0.1 + 0.2) / 2, 1e-6);
  EXPECT_EQ(chamfer_distance(q, q), 0);
  EXPECT_THROW(chamfer_distance(p, Points(0, 3)), Error);
  EXPECT_THROW(chamfer_distance(Points(0, 3), p), Error);
}

TEST(MeanVertexError, IsTheLengthOfAShift) {
  const Points q = random_points(50, 1);
  EXPECT_NEAR(mean_vertex_error(q.rowwise() + Eigen::RowVector3f(0, 0.003f, 0.004f), q), 0.005, 1e-6);
}

TEST(MeanVertexError, RefusesAnotherVertexCount) {
  EXPECT_THROW(mean_vertex_error(line(4), line(5)), Error);
}

TEST(AlignedVertexError, UndoesASimilarity) {
  const Points q = random_points(50, 1);
  const Points p = (0.7f * q * rotation_about_y(2).transpose()).rowwise() + Eigen::RowVector3f(1, 2, 3);
  EXPECT_LT(aligned_vertex_error(p, q), 1e-6);
}

TEST(AlignedVertexError, IsKnownForAStretchedCross) {
  // The truth is (+-1,0,0), (0,+-1,0), (0,0,+-1); the prediction stretches x to 2. Best scale s = (2+1+1)*2 /
  // (12) = 2/3: x errs by 1/3, y and z by 1/3.
  Points q(6, 3), p(6, 3);
  q << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  p = q;
  p.col(0) *= 2;
  EXPECT_NEAR(aligned_vertex_error(p, q), 1.0 / 3, 1e-6);
}

TEST(PartStretch, TellsHandsAndHeadFromTheRest) {
  Joints joints = Joints::Zero();
  joints(LeftWrist, 0) = 1, joints(RightWrist, 0) = -1, joints(Head, 1) = 1;
  Points rest(9, 3);
  rest << 1.1f, 0, 0, 1.3f, 0, 0, 1.1f, 0.2f, 0,  // left hand
      0.1f, 0, 0, 0.3f, 0, 0, 0.1f, 0.2f, 0,      // trunk
      0, 1.1f, 0, 0.2f, 1.1f, 0, 0, 1.3f, 0;      // head
  Faces faces(3, 3);
  faces << 0, 1, 2, 3, 4, 5, 6, 7, 8;
  const PartStretch parts(rest, faces, joints);
  const Mat3 turn = rotation_about_y(1);
  EXPECT_NEAR(parts.hands(rest * turn), 0, 1e-6);
  Points posed = rest;
  posed.topRows(3) *= 1.1f;
  posed.middleRows(3, 3) *= 3;
  EXPECT_NEAR(parts.hands(posed), 0.1, 1e-5);
  EXPECT_NEAR(parts.head(posed), 0, 1e-6);
  EXPECT_TRUE(std::isnan(PartStretch(rest, faces.middleRows(1, 1), joints).hands(rest)));
}

TEST(EdgeLengthError, IsZeroForARigidMove) {
  const Points q = random_points(300, 2);
  const Points p = (q * rotation_about_y(1).transpose()).rowwise() + Eigen::RowVector3f(1, 0, 0);
  EXPECT_LT(edge_length_error(p, q), 1e-6);
}

TEST(EdgeLengthError, IsKnownForAStretchedLine) {
  // Two nearest of 4 points in a line, 10 mm apart: ends see 10 and 20 mm, the middle ones 10 and 10.
  // Stretched by 1.1 each edge errs by a tenth: (1 + 2 + 1 + 1 + 1 + 1 + 1 + 2) / 8 = 1.25 mm.
  EXPECT_NEAR(edge_length_error(1.1f * line(4), line(4), 2), 0.00125, 1e-7);
}

TEST(EdgeLengthError, JoinsTheTrueNeighboursNotThePredictedOnes) {
  // True: two pairs, 1 mm within a pair. Predicted: the same places given to other vertices.
  Points q(4, 3), p(4, 3);
  q << 0, 0, 0, 0.001f, 0, 0, 1, 0, 0, 1.001f, 0, 0;
  p << 0, 0, 0, 1, 0, 0, 0.001f, 0, 0, 1.001f, 0, 0;
  EXPECT_NEAR(edge_length_error(p, q, 1), 0.999, 1e-4);
  EXPECT_NEAR(edge_length_error(q, q, 1), 0, 1e-9);
}

TEST(EdgeLengthError, AgreesWithAllPairs) {
  const Points q = random_points(200, 5), p = q + 0.05f * random_points(200, 6);
  double sum = 0;
  for (int v = 0; v < 200; ++v) {
    std::vector<std::pair<double, int>> others;
    for (int w = 0; w < 200; ++w)
      if (w != v) others.push_back({(q.row(v) - q.row(w)).cast<double>().norm(), w});
    std::sort(others.begin(), others.end());
    for (int i = 0; i < 6; ++i)
      sum += std::abs((p.row(v) - p.row(others[i].second)).cast<double>().norm() - others[i].first);
  }
  EXPECT_NEAR(edge_length_error(p, q), sum / 1200, 1e-7);
}

TEST(EdgeLengthError, TakesCoincidentVertices) {
  const Points q = Points::Zero(20, 3);
  Points p = q;
  EXPECT_EQ(edge_length_error(p, q), 0);
  EXPECT_EQ(edge_length_error(line(1), line(1)), 0);
}

TEST(FloorPenetration, IsTheDepthOfTheLowestVertex) {
  Points x = line(3);
  EXPECT_EQ(floor_penetration(x), 0);
  x(1, 1) = -0.02f;
  x(2, 1) = 0.5f;
  EXPECT_NEAR(floor_penetration(x), 0.02, 1e-7);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const Mesh mesh = box({0, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(winding_number(mesh.vertices, mesh.faces, {0.3f, 0.4f, 0.6f}), 1, 1e-5);
  EXPECT_NEAR(winding_number(mesh.vertices, mesh.faces, {1.3f, 0.4f, 0.6f}), 0, 1e-5);
}

TEST(InsideShare, CountsJointsOfAMesh) {
  Points points(4, 3);
  points << 0.5f, 0.5f, 0.5f, 0.1f, 0.1f, 0.9f, 0.5f, 0.9f, 0.2f, 2, 0, 0;
  EXPECT_DOUBLE_EQ(inside_share(box({0, 0, 0}, {1, 1, 1}), points), 0.75);
}

TEST(InsideShare, KnowsTheInsideOfACloud) {
  Mesh scan;
  scan.vertices = limb(0.08f, 3000);
  Points points(4, 3);
  points << 0, 0.5f, 0, 0.04f, 0.3f, 0, 0.2f, 0.5f, 0, 0.11f, 0.4f, 0.03f;  // two within the radius of 8 cm
  EXPECT_DOUBLE_EQ(inside_share(scan, points), 0.5);
}

TEST(InsideShare, IgnoresRowsThatAreNotNumbers) {
  Mesh scan;
  scan.vertices = limb(0.08f, 3000);
  scan.vertices.row(7).setConstant(NAN);
  EXPECT_DOUBLE_EQ(inside_share(scan, (Points(1, 3) << 0, 0.5f, 0).finished()), 1);
}

TEST(SelfPenetration, CountsVerticesThatEnteredAnotherPart) {
  const Mesh rest = together(box({0, 0, 0}, {1, 1, 1}), box({3, 0, 0}, {4, 1, 1}));
  const SelfPenetration evaluator(rest.vertices, rest.faces, 16);
  EXPECT_EQ(evaluator.share(rest.vertices), 0);
  Points posed = rest.vertices;
  posed.bottomRows(8).rowwise() +=
      Eigen::RowVector3f(-2.5f, 0.4f, 0.4f);            // one box enters the other by a corner edge
  EXPECT_NEAR(evaluator.share(posed), 2.0 / 16, 1e-9);  // a corner of each lies in the other
}

TEST(SelfPenetration, ForgivesWhatIsInsideInTheTPose) {
  const Mesh rest = together(box({0, 0, 0}, {1, 1, 1}), box({0.3f, 0.3f, 0.3f}, {0.6f, 0.6f, 0.6f}));
  EXPECT_EQ(SelfPenetration(rest.vertices, rest.faces, 16).share(rest.vertices), 0);
}

TEST(SelfPenetration, WantsFaces) {
  EXPECT_THROW(SelfPenetration(line(4), Faces(0, 3)), Error);
}

}  // namespace
}  // namespace understudy
