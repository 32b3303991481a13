// A surface at rest that follows nodes, each of which moves rigidly (embedded deformation, Sumner et al.
// 2007).
#pragma once

#include <vector>

#include "retarget/discovery/thinned_frames.hpp"
#include "retarget/math/rigid.hpp"

namespace understudy {

constexpr int kNodesOfPoint = 4;

struct DeformationGraph {
  Points nodes;                  ///< [G, 3] at rest, metres
  std::vector<int> node_points;  ///< [G] each node is one of the points
  Points points, normals;        ///< [N, 3] of the surface at rest
  Eigen::VectorXf radii;         ///< [N] half as thick as the body is there, metres
  SurfaceGraph surface;          ///< of the points
  Eigen::Matrix<int, Eigen::Dynamic, kNodesOfPoint, Eigen::RowMajor> near;      ///< [N, 4] nodes of a point
  Eigen::Matrix<float, Eigen::Dynamic, kNodesOfPoint, Eigen::RowMajor> shares;  ///< [N, 4], rows sum to 1
  struct Edge {
    int a, b;
    float length;  ///< metres, straight
  };
  std::vector<Edge> edges;  ///< between nodes that are neighbours along the surface, a < b
  float spacing;            ///< of neighbouring nodes, metres, mean

  int count() const { return static_cast<int>(nodes.rows()); }
};

/// `nodes` nodes, far apart on the surface of the frame's spread points.
DeformationGraph deformation_graph(const ThinnedFrame& rest, int nodes);

/// Where each node takes what is about it, from rest, [G].
using NodeMotions = std::vector<RigidMotion>;
/// The graph's points, moved, [N, 3].
Points deformed(const DeformationGraph& graph, const NodeMotions& motions);

}  // namespace understudy
