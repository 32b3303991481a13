// An arm of three bones along x that bends: a rig of which every figure is known.
#pragma once

#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy::test {

constexpr int kArmRings = 31, kArmSides = 8;

/// A closed tube from (0, 0, 0) to (3, 0, 0), radius 10 cm.
inline Mesh arm_surface() {
  Mesh mesh;
  mesh.vertices.resize(kArmRings * kArmSides + 2, 3);
  for (int ring = 0; ring < kArmRings; ++ring)
    for (int side = 0; side < kArmSides; ++side) {
      const float angle = 2 * kPi * side / kArmSides;
      mesh.vertices.row(ring * kArmSides + side) << 0.1f * ring, 0.1f * std::cos(angle),
          0.1f * std::sin(angle);
    }
  const int first = kArmRings * kArmSides, last = first + 1;
  mesh.vertices.row(first) << 0, 0, 0;
  mesh.vertices.row(last) << 3, 0, 0;
  std::vector<Eigen::RowVector3i> faces;
  for (int side = 0; side < kArmSides; ++side) {
    const int next = (side + 1) % kArmSides;
    for (int ring = 0; ring + 1 < kArmRings; ++ring) {
      const int a = ring * kArmSides + side, b = ring * kArmSides + next;
      faces.emplace_back(a, b, a + kArmSides);
      faces.emplace_back(b, b + kArmSides, a + kArmSides);
    }
    faces.emplace_back(first, next, side);
    faces.emplace_back(last, (kArmRings - 1) * kArmSides + side, (kArmRings - 1) * kArmSides + next);
  }
  mesh.faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t f = 0; f < faces.size(); ++f) mesh.faces.row(static_cast<Eigen::Index>(f)) = faces[f];
  return mesh;
}

/// A root at x = 0, a hinge about z at x = 1, a ball at x = 2; each vertex is of one bone.
inline Rig moving_arm() {
  Rig rig;
  rig.name = "arm";
  rig.joints = {{"root", -1, JointKind::Free, {0, 0, 0}, Vec3::UnitY()},
                {"elbow", 0, JointKind::Hinge, {1, 0, 0}, Vec3::UnitZ()},
                {"wrist", 1, JointKind::Ball, {2, 0, 0}, Vec3::UnitY()}};
  rig.surface = arm_surface();
  std::vector<int> bones;
  for (const auto& v : rig.surface.vertices.rowwise())
    bones.push_back(v.x() < 0.95f ? 0 : v.x() < 1.95f ? 1 : 2);
  rig.skin = SkinWeights::rigid(bones);
  return rig;
}

/// From rest the elbow bends by 60 degrees, the wrist by 40 about y, the root turns and goes.
inline RiggedMotion bending_arm(int frames = 7) {
  RiggedMotion arm{moving_arm(), {}};
  for (int t = 0; t < frames; ++t) {
    const float u = frames > 1 ? static_cast<float>(t) / static_cast<float>(frames - 1) : 0;
    RigPose pose = rest_pose(arm.rig);
    pose.root = Vec3(0, 0.3f * u, 0.2f * u);
    pose.turns[0] = rotation_from_axis_angle({0, 0.3f * u, 0});
    pose.turns[1] = rotation_from_axis_angle({0, 0, kPi / 3 * u});
    pose.turns[2] = rotation_from_axis_angle({0, kPi * 40 / 180 * u, 0});
    arm.motion.poses.push_back(pose);
  }
  return arm;
}

/// Its surface in each frame, as scans.
inline std::vector<Mesh> scans_of(const RiggedMotion& performed) {
  std::vector<Mesh> scans;
  for (const RigPose& pose : performed.motion.poses)
    scans.push_back(
        {skinned(performed.rig.surface.vertices, performed.rig.skin, bone_motions(performed.rig, pose)),
         performed.rig.surface.faces});
  return scans;
}

}  // namespace understudy::test
