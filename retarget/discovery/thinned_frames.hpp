// Scans of a moving thing, thinned to what finding its skeleton looks at.
#pragma once

#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/geometry/point_tree.hpp"

namespace understudy {

/// Points of one scan. The first ones lie far apart, evenly spread; the others make its surface denser.
struct ThinnedFrame {
  Points points;   ///< [N, 3] metres
  Points normals;  ///< [N, 3] outwards, unit length; zero where there are too few points about
  int spread = 0;  ///< so many of them, from the first on, are those far apart
  PointTree tree;  ///< of the points
};

/// A scan without its vertices that are not finite.
Mesh finite_part(Mesh scan);

/// `spread` points of a scan that lie far apart, and others up to `count`; fewer where it has fewer. The same
/// scan and seed give the same points. Throws Error for a scan without 30 finite points.
ThinnedFrame thinned(const Mesh& scan, int spread, int count, uint64_t seed);
/// Those far apart alone.
ThinnedFrame spread_part(const ThinnedFrame& frame);

/// Neighbours along a surface: each point with its nearest ones, both ways, [N]. Pieces that do not touch are
/// joined where they are nearest.
struct SurfaceGraph {
  struct Edge {
    int to;
    float length;  ///< metres
  };
  std::vector<std::vector<Edge>> edges;
};
/// Points whose normals face each other are no neighbours: the two sides of a gap are not one surface.
SurfaceGraph surface_graph(const ThinnedFrame& frame);

/// Lengths of the shortest paths along the graph from one of its points, at most `reach`; infinite where
/// beyond. [N]
std::vector<float> distances_along(const SurfaceGraph& graph, int from, float reach);

/// How far apart along the surface the points of a scan are, mean over pairs, metres: limbs that touch
/// shorten the paths, so the most open pose of a body has the longest.
float openness(const ThinnedFrame& frame);

}  // namespace understudy
