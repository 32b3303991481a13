#include "retarget/discovery/deformation_graph.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "retarget/geometry/inner_balls.hpp"

namespace understudy {
namespace {

constexpr int kNodeNeighbours = 6;
constexpr float kThinnest = 0.01f;  // of the body's diagonal: radius; nothing is seen as thinner

using NearNodes = std::vector<std::pair<float, int>>;  // distance along the surface, node

/// Of each point the nodes within `reach` along the surface, nearest first; the nearest where none is.
std::vector<NearNodes> nodes_near_points(const Points& points, const std::vector<int>& nodes,
                                         const SurfaceGraph& surface, float reach) {
  const PointTree tree(points(nodes, Eigen::all));
  std::vector<NearNodes> near(surface.edges.size());
  for (size_t k = 0; k < nodes.size(); ++k) {
    const std::vector<float> distance = distances_along(surface, nodes[k], reach);
    for (size_t i = 0; i < distance.size(); ++i)
      if (distance[i] <= reach) near[i].push_back({distance[i], static_cast<int>(k)});
  }
  for (size_t i = 0; i < near.size(); ++i) {
    if (near[i].empty())
      near[i].push_back({reach, tree.nearest(points.row(static_cast<Eigen::Index>(i)).transpose()).point});
    std::sort(near[i].begin(), near[i].end());
  }
  return near;
}

/// Shares fall to nothing at the first node that has none.
void bind(const std::vector<NearNodes>& near, DeformationGraph& graph) {
  const auto count = static_cast<Eigen::Index>(near.size());
  graph.near.setZero(count, kNodesOfPoint);
  graph.shares.setZero(count, kNodesOfPoint);
  for (Eigen::Index i = 0; i < count; ++i) {
    const NearNodes& nodes = near[static_cast<size_t>(i)];
    const size_t used = std::min<size_t>(nodes.size(), kNodesOfPoint);
    const float end =
        nodes.size() > kNodesOfPoint ? nodes[kNodesOfPoint].first : 1.5f * nodes[used - 1].first;
    for (size_t k = 0; k < used; ++k) {
      const float fall = 1 - nodes[k].first / std::max(end, 1e-9f);
      graph.near(i, static_cast<Eigen::Index>(k)) = nodes[k].second;
      graph.shares(i, static_cast<Eigen::Index>(k)) = std::max(fall * fall, 1e-6f);
    }
    graph.shares.row(i) /= graph.shares.row(i).sum();
  }
}

void connect(const std::vector<NearNodes>& near, const std::vector<int>& nodes, DeformationGraph& graph) {
  for (size_t k = 0; k < nodes.size(); ++k) {
    int found = 0;
    for (const auto& [distance, other] : near[static_cast<size_t>(nodes[k])]) {
      const auto a = std::min(static_cast<int>(k), other), b = std::max(static_cast<int>(k), other);
      if (a == b) continue;
      if (++found > kNodeNeighbours) break;
      graph.edges.push_back({a, b, (graph.nodes.row(a) - graph.nodes.row(b)).norm()});
    }
  }
  const auto order = [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); };
  const auto same = [](const auto& x, const auto& y) { return x.a == y.a && x.b == y.b; };
  std::sort(graph.edges.begin(), graph.edges.end(), order);
  graph.edges.erase(std::unique(graph.edges.begin(), graph.edges.end(), same), graph.edges.end());
  double sum = 0;
  for (const DeformationGraph::Edge& edge : graph.edges) sum += edge.length;
  graph.spacing = static_cast<float>(sum / static_cast<double>(std::max<size_t>(graph.edges.size(), 1)));
}

}  // namespace

DeformationGraph deformation_graph(const ThinnedFrame& whole, int nodes) {
  const ThinnedFrame rest = spread_part(whole);
  const std::vector<int> chosen =
      farthest_points(rest.points, static_cast<int>(std::min<Eigen::Index>(nodes, rest.points.rows())));
  DeformationGraph graph;
  graph.surface = surface_graph(rest);
  graph.node_points = chosen;
  graph.points = rest.points;
  graph.normals = rest.normals;
  graph.radii = inner_radii(rest.tree, rest.normals).cwiseMax(kThinnest * box_diagonal(rest.points));
  graph.nodes = rest.points(chosen, Eigen::all);
  // Nodes cover the surface: none is further than the last chosen one from those before it.
  const float gap = [&] {
    const PointTree tree(graph.nodes);
    float widest = 0;
    for (Eigen::Index i = 0; i < rest.points.rows(); ++i)
      widest = std::max(widest, tree.nearest(rest.points.row(i).transpose()).squared);
    return std::sqrt(widest);
  }();
  const std::vector<NearNodes> near = nodes_near_points(rest.points, chosen, graph.surface, 5 * gap);
  bind(near, graph);
  connect(near, chosen, graph);
  return graph;
}

Points deformed(const DeformationGraph& graph, const NodeMotions& motions) {
  Points moved(graph.points.rows(), 3);
  for (Eigen::Index i = 0; i < moved.rows(); ++i) {
    const Vec3 x = graph.points.row(i).transpose();
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kNodesOfPoint; ++k)
      sum += graph.shares(i, k) * motions[static_cast<size_t>(graph.near(i, k))](x);
    moved.row(i) = sum.transpose();
  }
  return moved;
}

}  // namespace understudy
