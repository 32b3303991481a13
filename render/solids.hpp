// Bones, balls, arrows and rings: solids of revolution as one coloured mesh, and skeletons made of them.
#pragma once

#include <vector>

#include "render/scene.hpp"

namespace understudy::render {

class Solids {
 public:
  /// A circle of vertices around an axis.
  struct Ring {
    Vec3 center;
    float radius;
    float slope;  ///< of the normal along the axis: 0 straight out, > 0 towards the axis's end
  };
  /// Rings stacked along a unit axis, each joined to the one before.
  void add(const std::vector<Ring>& rings, const Vec3& axis, const Vec3& color);
  void add_ball(const Vec3& center, float radius, const Vec3& color);
  /// A shaft with a head, closed behind.
  void add_arrow(const Vec3& from, const Vec3& to, float thickness, const Vec3& color);
  /// A ring of round section about a unit axis.
  void add_torus(const Vec3& center, const Vec3& axis, float radius, float thickness, const Vec3& color);
  /// A flat parallelogram, both sides.
  void add_plate(const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& color);

  MeshView mesh() const;

 private:
  int add_vertex(const Vec3& position, const Vec3& normal, const Vec3& color);
  void add_quads(int first, int second, int around);

  std::vector<Vec3> positions_, normals_, colors_;
  std::vector<Eigen::RowVector3i> faces_;
};

/// The solids of a skeleton as one coloured mesh with its own normals. Joints that are not finite, and bones
/// to them, are left out. Throws Error when parents or sides do not fit the joints.
MeshView skeleton_solids(const SkeletonView& view);

}  // namespace understudy::render
