// A triangle mesh, or a point cloud when it has no faces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

struct Mesh {
  Points vertices;      ///< [V, 3] metres
  Faces faces{0, 3};    ///< [F, 3]; empty for a point cloud
  Points colors{0, 3};  ///< [V, 3] in 0..1; empty when the file has none
  bool is_cloud() const { return faces.rows() == 0; }
};

/// Diagonal of the box about the points, metres.
float box_diagonal(const Points& points);

/// Area-weighted vertex normals, [V, 3], unit length (zero where no face touches).
Points vertex_normals(const Points& vertices, const Faces& faces);

/// Whether every edge has a face on either side, so that the inside cannot be seen.
bool is_closed(const Faces& faces);

/// Picks points on a surface uniformly by area. Build once per mesh, then sample as often as wanted.
class SurfaceSampler {
 public:
  /// One sample: a triangle and barycentric weights of its three corners.
  struct Sample {
    int face;
    Vec3 barycentric;
  };
  /// Throws Error when the mesh has no face or no area.
  SurfaceSampler(const Points& vertices, const Faces& faces);
  Sample sample(Rng& rng) const;
  /// Of the whole surface.
  float area() const { return static_cast<float>(cumulative_area_.back()); }

 private:
  std::vector<double> cumulative_area_;  // [F]
};

/// `count` points on the surface, uniform by area; from a cloud, `count` of its points (all, when it has
/// fewer).
Points sample_points(const Mesh& mesh, int count, Rng& rng);

/// Indices of `count` points that lie far apart (farthest point sampling from `first`); count <=
/// points.rows().
std::vector<int> farthest_points(const Points& points, int count, int first = 0);
/// The same among the points `of`, from the first of them; at most `count`.
std::vector<int> far_apart(const Points& points, const std::vector<int>& of, int count);

/// Of a cloud with more than `most` finite points so many of them at most, with their colours, spread evenly
/// over its order and in it: one of each run of points, the same ones for the same numbers. Others and meshes
/// stay as they are.
void thin_cloud(Mesh& scan, Eigen::Index most);
/// The points without NaN and infinities, in their order.
Points finite_points(const Points& points);
/// How many points are finite.
Eigen::Index finite_count(const Points& points);

/// The part of a scan whose vertices have `kept` [V] not 0, in its old order, colours too: of a cloud those
/// vertices, of a mesh the faces whose three corners stay and the vertices that these use.
Mesh kept_part(const Mesh& scan, const std::vector<char>& kept);

using IntMatrix = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// For each query the indices of its k nearest points, nearest first, [Q, k]; k <= points.rows(). Exact.
IntMatrix nearest_neighbours(const Points& points, const Points& queries, int k);

}  // namespace understudy
