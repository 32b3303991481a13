// An arm that bends, as clouds of points.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "retarget/discovery/discover.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {

/// A tube from a to b with round ends; points on its surface.
inline Points tube(const Vec3& a, const Vec3& b, float radius, int count, Rng& rng) {
  const Vec3 along = (b - a).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
  const float length = (b - a).norm();
  Points points(count, 3);
  for (int i = 0; i < count; ++i) {
    const float at = rng.uniform(-radius, length + radius), angle = rng.uniform(0, 2 * kPi);
    const float beyond = std::max({0.0f, -at, at - length});
    const float r = std::sqrt(std::max(0.0f, radius * radius - beyond * beyond));
    // Oval, so that a turn about its length is seen.
    points.row(i) = (a + at * along + r * (std::cos(angle) * u + 0.6f * std::sin(angle) * v)).transpose();
  }
  return points;
}

inline const Vec3 kElbow(0.5f, 0, 0);

/// Two tubes; the second turns about z at the elbow.
inline Mesh bent_arm(float angle, uint64_t seed, const Vec3& moved = Vec3::Zero()) {
  Rng rng(seed);
  Points points(4000, 3);
  points.topRows(2000) = tube(Vec3::Zero(), kElbow, 0.06f, 2000, rng);
  const Mat3 turn = rotation_from_axis_angle({0, 0, angle});
  const Points fore = tube(kElbow, {1.0f, 0, 0}, 0.06f, 2000, rng);
  points.bottomRows(2000) =
      ((fore.rowwise() - kElbow.transpose()) * turn.transpose()).rowwise() + kElbow.transpose();
  Mesh mesh;
  mesh.vertices = points.rowwise() + moved.transpose();
  return mesh;
}

/// Evenly chosen points: a search in few takes a fraction of the time.
inline Mesh sparse(const Mesh& scan, int count) {
  Mesh few;
  few.vertices.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i)
    few.vertices.row(i) = scan.vertices.row(i * scan.vertices.rows() / count);
  return few;
}

inline Mesh sparse_arm(float angle, int t, const Vec3& moved = Vec3::Zero()) {
  return sparse(bent_arm(angle, static_cast<uint64_t>(t), moved), 1000);
}

inline ScanSequence sequence(int count, const std::function<Mesh(int)>& scan) {
  ScanSequence scans;
  scans.count = count;
  scans.scan = scan;
  return scans;
}

constexpr int kFrames = 10;
inline float angle_at(int t) {
  return 1.2f * static_cast<float>(t) / (kFrames - 1);
}
inline ScanSequence bending_arm() {
  return sequence(kFrames, [](int t) { return bent_arm(angle_at(t), static_cast<uint64_t>(t)); });
}

/// What is found in it, once for all tests.
inline const DiscoveredRig& found_arm() {
  static const DiscoveredRig rig = discover(bending_arm());
  return rig;
}

}  // namespace understudy
