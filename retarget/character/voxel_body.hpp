// The solid under a surface as a grid of small cubes, and the paths through it.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Cubes that the surface passes or encloses. Copes with holes, several parts, faces that cross, and clouds:
/// a cube counts as enclosed when nothing from outside comes to it, or when it sees the surface in five of
/// the six directions along the axes. Parts that do not touch are joined where they are nearest.
class VoxelBody {
 public:
  /// resolution: cubes along the longest side. Throws Error without a finite vertex.
  explicit VoxelBody(const Mesh& mesh, int resolution = 128);

  float size() const { return size_; }         ///< of a cube, metres
  int count() const { return cells_.size(); }  ///< of cubes in the solid
  Vec3 centre(int cell) const;
  /// The cube of the solid that a point lies in, -1 for none.
  int cell_at(const Vec3& point) const;
  /// The cube of the solid nearest to a point.
  int nearest_cell(const Vec3& point) const;
  /// Length of the shortest path through the solid from any of these segments, [count()] metres; a segment
  /// that lies outside starts at the cubes nearest to it.
  std::vector<float> distances_from(const std::vector<std::pair<Vec3, Vec3>>& segments) const;
  /// Such lengths at any point: of the cubes about it.
  float at(const std::vector<float>& distances, const Vec3& point) const;

 private:
  struct Bridge {
    int a, b;
    float length;
  };
  int grid_index(int x, int y, int z) const { return (z * dims_[1] + y) * dims_[0] + x; }
  Eigen::Vector3i grid_place(int index) const {
    return {index % dims_[0], index / dims_[0] % dims_[1], index / (dims_[0] * dims_[1])};
  }
  std::array<int, 3> place(const Vec3& point) const;
  void lay_grid(const Points& vertices, int resolution);
  void mark_surface(const Mesh& mesh, std::vector<char>& state) const;
  void mark_reached(std::vector<char>& state) const;
  void mark_enclosed(std::vector<char>& state) const;
  void number_cells(const std::vector<char>& state);
  void join_parts();
  std::vector<int> label_parts() const;

  float size_ = 1;
  Vec3 origin_ = Vec3::Zero();
  std::array<int, 3> dims_{};
  std::vector<int> cell_of_;                  // [grid], -1: not in the solid
  std::vector<int> cells_;                    // grid index of each cube of the solid
  std::vector<std::vector<Bridge>> bridges_;  // by cube; empty where there is one part
};

}  // namespace understudy
