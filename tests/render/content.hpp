// Things to draw in tests, made by formula.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/camera.hpp"
#include "render/scene.hpp"

namespace understudy::render {

/// A closed pear with two bumps for arms and a nose towards +z, standing on y = 0: no two sides look the
/// same.
inline Mesh make_pear(int rings = 40, int around = 56, float height = 1.2f) {
  Mesh mesh;
  mesh.vertices.resize(rings * around, 3);
  mesh.faces.resize(2 * (rings - 1) * around, 3);
  int face = 0;
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const float up = static_cast<float>(r) / static_cast<float>(rings - 1), v = kPi * up;
      const float u = 2 * kPi * static_cast<float>(k) / static_cast<float>(around);  // 0 is +z, then +x
      const float arms = 0.35f * std::exp(-40 * (up - 0.62f) * (up - 0.62f)) * std::pow(std::sin(u), 8.f);
      const float nose =
          0.14f * std::exp(-90 * (up - 0.8f) * (up - 0.8f)) * std::pow(std::max(0.f, std::cos(u)), 12.f);
      const float radius = height * ((0.34f - 0.14f * up) * std::sin(v) + (arms + nose) * std::sin(v));
      mesh.vertices.row(r * around + k) << radius * std::sin(u), height * (0.5f - 0.5f * std::cos(v)),
          radius * std::cos(u);
      if (r == 0) continue;
      const int a = r * around + k, b = r * around + (k + 1) % around;
      mesh.faces.row(face++) << a, a - around, b - around;
      mesh.faces.row(face++) << a, b - around, b;
    }
  return mesh;
}

/// A standing person of 1.7 m, arms out.
inline Joints make_joints() {
  Joints joints;
  joints << 0, .95f, 0, .09f, .88f, 0, -.09f, .88f, 0, 0, 1.06f, 0, .11f, .50f, .01f, -.11f, .50f, .01f, 0,
      1.19f, 0, .12f, .09f, -.02f, -.12f, .09f, -.02f, 0, 1.25f, 0, .14f, .03f, .11f, -.14f, .03f, .11f, 0,
      1.45f, 0, .07f, 1.37f, 0, -.07f, 1.37f, 0, 0, 1.58f, .02f, .18f, 1.39f, -.01f, -.18f, 1.39f, -.01f,
      .44f, 1.38f, -.02f, -.44f, 1.38f, -.02f, .69f, 1.38f, 0, -.69f, 1.38f, 0;
  return joints;
}

/// A person of tubes about the bones of make_joints(), about `vertices` vertices (and twice as many faces).
inline Mesh make_person(int vertices = 13000) {
  const Joints joints = make_joints();
  const int rings = std::max(4, static_cast<int>(std::lround(std::sqrt(vertices / 21.0)))), around = rings;
  Mesh mesh;
  mesh.vertices.resize(21 * rings * around, 3);
  mesh.faces.resize(21 * 2 * (rings - 1) * around, 3);
  int face = 0, base = 0;
  for (int j = 1; j < kJointCount; ++j, base += rings * around) {
    const Vec3 a = joints.row(kParents[j]), along = joints.row(j).transpose() - a;
    const Vec3 w = along.normalized(), u = w.unitOrthogonal(), v = w.cross(u);
    const float thick = kMirror[j] == j ? 0.13f : 0.065f;
    for (int r = 0; r < rings; ++r)
      for (int k = 0; k < around; ++k) {
        const float t = static_cast<float>(r) / static_cast<float>(rings - 1) * kPi;
        const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(around);
        const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
        const float radius = thick * std::sqrt(std::max(0.f, std::sin(t)));
        mesh.vertices.row(base + r * around + k) =
            (a + (0.5f - 0.62f * std::cos(t)) * along + radius * out).transpose();
        if (r == 0) continue;
        const int here = base + r * around + k, next = base + r * around + (k + 1) % around;
        mesh.faces.row(face++) << here, here - around, next - around;
        mesh.faces.row(face++) << here, next - around, next;
      }
  }
  return mesh;
}

/// Three-quarter view of all of a scene.
inline Camera view_of(const Scene& scene, float aspect = 1) {
  Camera camera;
  camera.yaw = -0.5f;
  camera.pitch = 0.2f;
  return fitted(camera, all_points(scene), aspect, 0.08f);
}

}  // namespace understudy::render
