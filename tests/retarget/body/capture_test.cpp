#include "retarget/body/capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"

namespace understudy {
namespace {

const ShapedBody& standing() {
  static const ShapedBody body = [] {
    ShapedBody b = builtin_person();
    b.vertices.col(1).array() -= b.vertices.col(1).minCoeff();
    return b;
  }();
  return body;
}

Mesh capture(int frame, const CaptureOptions& options = {}) {
  return simulated_capture(standing().vertices, standing().faces, frame, options);
}

/// Distance to the nearest of dense samples of the surface, one a point.
Eigen::VectorXf distances(const Points& cloud) {
  Rng rng(3);
  Mesh mesh;
  mesh.vertices = standing().vertices, mesh.faces = standing().faces;
  const Points surface = sample_points(mesh, 60000, rng);
  const auto nearest = nearest_neighbours(surface, cloud, 1);
  Eigen::VectorXf d(cloud.rows());
  for (int i = 0; i < cloud.rows(); ++i) d[i] = (cloud.row(i) - surface.row(nearest(i, 0))).norm();
  return d;
}

TEST(Capture, CountsChangeFromFrameToFrame) {
  std::vector<Eigen::Index> counts;
  for (int i = 0; i < 6; ++i) counts.push_back(capture(i).vertices.rows());
  for (size_t i = 1; i < counts.size(); ++i) EXPECT_NE(counts[i], counts[i - 1]);
  for (auto count : counts) {
    EXPECT_GT(count, 3500);
    EXPECT_LT(count, 6500);
  }
}

TEST(Capture, MostPointsLieOnTheBodyWithinTheNoise) {
  const Mesh cloud = capture(0);
  const Eigen::VectorXf d = distances(cloud.vertices);
  EXPECT_TRUE(cloud.is_cloud());
  EXPECT_GT((d.array() < 0.015f).count(), 0.90 * static_cast<double>(d.size()));
  EXPECT_GT((d.array() > 0.003f).count(), 0.2 * static_cast<double>(d.size()));  // there is noise
}

TEST(Capture, HasSomeFloorAndAFewOutliers) {
  const Mesh cloud = capture(1);
  const Eigen::VectorXf d = distances(cloud.vertices);
  int floor = 0, stray = 0;
  for (int i = 0; i < d.size(); ++i) {
    if (d[i] < 0.03f) continue;
    (std::abs(cloud.vertices(i, 1)) < 0.02f ? floor : stray) += 1;
  }
  EXPECT_GT(floor, 50);
  EXPECT_GT(stray, 2);
  EXPECT_LT(stray, 60);
  CaptureOptions clean;
  clean.floor = clean.outliers = clean.noise = 0;
  EXPECT_LT(distances(capture(1, clean).vertices).maxCoeff(), 0.02f);
}

TEST(Capture, HolesLeavePartsOfTheBodyBare) {
  const auto bare = [](int holes) {
    CaptureOptions o;
    o.holes = holes, o.points = 12000, o.outliers = o.floor = 0;
    const Mesh cloud = capture(2, o);
    const auto nearest = nearest_neighbours(cloud.vertices, standing().vertices, 1);
    int count = 0;
    for (int v = 0; v < standing().vertices.rows(); ++v)
      count += (cloud.vertices.row(nearest(v, 0)) - standing().vertices.row(v)).norm() > 0.02f;
    return count;
  };
  EXPECT_GT(bare(12), bare(0) + 100);
}

TEST(Capture, DensityDiffersByView) {
  CaptureOptions o;
  o.points = 20000, o.holes = 0;
  const Mesh cloud = capture(0, o);
  std::array<int, 8> by_sector{};
  for (int i = 0; i < cloud.vertices.rows(); ++i) {
    if (cloud.vertices(i, 1) < 0.9f || cloud.vertices(i, 1) > 1.3f) continue;
    const float angle = std::atan2(cloud.vertices(i, 0), cloud.vertices(i, 2));
    ++by_sector[static_cast<size_t>(std::clamp((angle / (2 * kPi) + 0.5f) * 8, 0.0f, 7.0f))];
  }
  const auto [low, high] = std::minmax_element(by_sector.begin(), by_sector.end());
  EXPECT_GT(*high, 1.3 * *low);
}

TEST(Capture, OrderTellsNothing) {
  // Neighbours in the list are as far apart as any two points.
  const Mesh cloud = capture(0);
  float step = 0;
  for (int i = 1; i < cloud.vertices.rows(); ++i)
    step += (cloud.vertices.row(i) - cloud.vertices.row(i - 1)).norm();
  EXPECT_GT(step / static_cast<float>(cloud.vertices.rows()), 0.4f);
}

TEST(Capture, SameSeedAndFrameGiveTheSameBytes) {
  EXPECT_TRUE(capture(4).vertices == capture(4).vertices);
  CaptureOptions other;
  other.seed = 2;
  EXPECT_FALSE(capture(4, other).vertices.row(0) == capture(4).vertices.row(0));
}

TEST(Capture, RefusesAMeshWithoutFaces) {
  EXPECT_THROW(simulated_capture(standing().vertices, Faces(0, 3), 0), Error);
  EXPECT_THROW(simulated_capture(Points(0, 3), standing().faces, 0), Error);
}

}  // namespace
}  // namespace understudy
