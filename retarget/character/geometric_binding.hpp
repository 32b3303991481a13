// Skin weights from the shape alone: distances through the solid from the bones (geodesic voxel binding,
// Dionne and de Lasa 2013), with skirts seen and parts of their own kept rigid.
#pragma once

#include <optional>
#include <vector>

#include "retarget/character/voxel_body.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// How far points of a body are from each joint's bones.
struct BoneDistances {
  RowMatrix metres;  ///< [K, 22]: straight, with detours through the solid added
  float leg = 1;     ///< of the body, metres
};
/// at: [K, 3].
BoneDistances bone_distances(const VoxelBody& body, const Joints& joints, const Points& at);

/// Weights [K, 22] by the inverse of the distances alone, rows sum to 1.
RowMatrix weights_by_distance(const BoneDistances& distances);

/// Cloth that hangs about both legs.
struct Skirt {
  float hem = 0;          ///< its height, metres
  Eigen::VectorXf share;  ///< [V] how far a vertex is bound as cloth, 0..1
  RowMatrix weights;      ///< [V, 22] pelvis and thighs; rows of vertices with a share sum to 1
};
/// None where the surface between the legs is not closed in front and behind down to the middle of the
/// thighs, and for clouds.
std::optional<Skirt> find_skirt(const Mesh& mesh, const Joints& joints);

/// How far each vertex belongs to a head much larger than a human's, [V] 0..1, fading at the neck: the
/// narrowest slice between crown and shoulders of an upright body. All 0 where the head is of usual size or
/// no neck is seen, and for clouds.
Eigen::VectorXf big_head(const Mesh& mesh, const Joints& joints);
/// The middle of that slice; none where the head is of usual size.
std::optional<Vec3> neck_under_big_head(const Mesh& mesh, const Joints& joints);

/// What is seen in the shape, besides distances.
struct ShapeHints {
  std::optional<Skirt> skirt;
  Eigen::VectorXf head;  ///< [V]
};
ShapeHints shape_hints(const Mesh& mesh, const Joints& joints);

/// Skin weights [V, 22] of a body in any upright pose, rows sum to 1: by the inverse of the distances,
/// smoothed along the surface; a skirt follows pelvis and thighs, a big head is rigid. Distances and hints
/// are those of that pose.
RowMatrix geometric_weights(const Mesh& mesh, const BoneDistances& distances, const ShapeHints& hints);

/// Spreads values [V, K] along edges as far as a few centimetres; vertices far apart hardly mix.
void smooth_along(const Mesh& mesh, float radius, RowMatrix& values);

/// Gives one transform to each part that is rigid: small ones (eyes, buttons, glasses), and all of a body
/// that is made of separate pieces, a bone each. True for the vertices of such parts.
std::vector<bool> keep_parts_rigid(const Mesh& mesh, float leg, RowMatrix& weights);

}  // namespace understudy
