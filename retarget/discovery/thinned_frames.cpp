#include "retarget/discovery/thinned_frames.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy {
namespace {

constexpr int kFewest = 30;
constexpr int kSurfaceNeighbours = 7;
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kDensity = 3;  // so many times the points are drawn before those far apart are chosen

/// Points drawn evenly on a surface, each with its face's normal.
std::pair<Points, Points> drawn_from(const Mesh& scan, int count, uint64_t seed) {
  const SurfaceSampler sampler(scan.vertices, scan.faces);
  Rng rng(seed);
  Points points(count, 3), normals(count, 3);
  for (int i = 0; i < count; ++i) {
    const SurfaceSampler::Sample sample = sampler.sample(rng);
    const auto corner = [&](int k) {
      return Vec3(scan.vertices.row(scan.faces(sample.face, k)).transpose());
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    points.row(i) =
        (sample.barycentric.x() * a + sample.barycentric.y() * b + sample.barycentric.z() * c).transpose();
    normals.row(i) = (b - a).cross(c - a).normalized().transpose();
  }
  return {points, normals};
}

Points rows_of(const Points& points, const std::vector<int>& rows) {
  return points(rows, Eigen::all);
}

void join_pieces(const Points& points, SurfaceGraph& graph) {
  const auto count = static_cast<int>(points.rows());
  UnionFind sets(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i)
    for (const SurfaceGraph::Edge& edge : graph.edges[static_cast<size_t>(i)]) sets.join(i, edge.to);
  for (;;) {  // the first point's set with what is nearest to it
    std::vector<int> inside, outside;
    for (int i = 0; i < count; ++i) (sets.root(i) == sets.root(0) ? inside : outside).push_back(i);
    if (outside.empty()) return;
    const PointTree tree(rows_of(points, inside));
    PointTree::Near best{0, kFar};
    int from = outside.front();
    for (const int i : outside) {
      const PointTree::Near near = tree.nearest(points.row(i).transpose());
      if (near.squared < best.squared) best = near, from = i;
    }
    const int to = inside[static_cast<size_t>(best.point)];
    const float length = std::sqrt(best.squared);
    graph.edges[static_cast<size_t>(from)].push_back({to, length});
    graph.edges[static_cast<size_t>(to)].push_back({from, length});
    sets.join(from, to);
  }
}

}  // namespace

Mesh finite_part(Mesh scan) {
  if (scan.vertices.allFinite()) return scan;
  std::vector<char> kept;
  kept.reserve(static_cast<size_t>(scan.vertices.rows()));
  for (const auto& vertex : scan.vertices.rowwise()) kept.push_back(vertex.allFinite() ? 1 : 0);
  return kept_part(scan, kept);
}

ThinnedFrame thinned(const Mesh& scan, int spread, int count, uint64_t seed) {
  Points points = finite_points(scan.vertices), normals(0, 3);
  US_CHECK(points.rows() >= kFewest, "a scan of ", points.rows(), " points is too few to find a skeleton in");
  if (!scan.is_cloud() && points.rows() == scan.vertices.rows())
    std::tie(points, normals) = drawn_from(scan, std::max(count, kDensity * spread), seed);
  else
    normals = pointed_outwards(points, estimated_normals(points));
  Rng rng(seed);
  const auto all = static_cast<int>(points.rows());
  std::vector<int> chosen = farthest_points(points, std::min(spread, all), rng.below(all));
  const auto first = static_cast<int>(chosen.size());
  std::vector<char> taken(static_cast<size_t>(all), 0);
  for (const int i : chosen) taken[static_cast<size_t>(i)] = 1;
  const int more = std::min(count, all) - first;
  for (int i = 0, left = all - first; i < all && more > 0; ++i) {  // evenly among what is left
    if (taken[static_cast<size_t>(i)]) continue;
    const int have = static_cast<int>(chosen.size()) - first;
    if (static_cast<int64_t>(have) * (all - first) <= static_cast<int64_t>(all - first - left) * more &&
        have < more)
      chosen.push_back(i);
    --left;
  }
  Points kept = rows_of(points, chosen);
  return {kept, rows_of(normals, chosen), first, PointTree(kept)};
}

ThinnedFrame spread_part(const ThinnedFrame& frame) {
  Points points = frame.points.topRows(frame.spread);
  return {points, frame.normals.topRows(frame.spread), frame.spread, PointTree(points)};
}

SurfaceGraph surface_graph(const ThinnedFrame& frame) {
  const auto count = static_cast<int>(frame.points.rows());
  SurfaceGraph graph;
  graph.edges.resize(static_cast<size_t>(count));
  std::vector<PointTree::Near> near;
  const auto opposed = [&](int a, int b) {
    const auto na = frame.normals.row(a), nb = frame.normals.row(b);
    const auto along = (frame.points.row(b) - frame.points.row(a)).normalized();
    constexpr float kAcross = 0.6f;  // cosine: what lies before a surface, not in it
    const bool across = std::abs(along.dot(na)) > kAcross && std::abs(along.dot(nb)) > kAcross;
    return across || na.dot(nb) < -0.3f;
  };
  const auto add = [&](int a, int b, float length) {
    auto& edges = graph.edges[static_cast<size_t>(a)];
    const bool known =
        std::any_of(edges.begin(), edges.end(), [b](const auto& edge) { return edge.to == b; });
    if (!known) edges.push_back({b, length});
  };
  for (int i = 0; i < count; ++i) {
    frame.tree.nearest(frame.points.row(i).transpose(), kSurfaceNeighbours, near);
    for (const PointTree::Near& n : near) {
      if (n.point == i || opposed(i, n.point)) continue;
      const float length = std::sqrt(n.squared);
      add(i, n.point, length);
      add(n.point, i, length);
    }
  }
  join_pieces(frame.points, graph);
  return graph;
}

std::vector<float> distances_along(const SurfaceGraph& graph, int from, float reach) {
  std::vector<float> distance(graph.edges.size(), kFar);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[static_cast<size_t>(from)] = 0;
  open.push({0.0f, from});
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > distance[static_cast<size_t>(i)]) continue;
    for (const SurfaceGraph::Edge& edge : graph.edges[static_cast<size_t>(i)]) {
      const float further = d + edge.length;
      if (further >= distance[static_cast<size_t>(edge.to)] || further > reach) continue;
      distance[static_cast<size_t>(edge.to)] = further;
      open.push({further, edge.to});
    }
  }
  return distance;
}

float openness(const ThinnedFrame& whole) {
  constexpr int kLandmarks = 16;
  const ThinnedFrame frame = spread_part(whole);
  const SurfaceGraph graph = surface_graph(frame);
  const auto count = static_cast<int>(std::min<Eigen::Index>(kLandmarks, frame.points.rows()));
  const std::vector<int> landmarks = farthest_points(frame.points, count);
  double sum = 0;
  for (const int from : landmarks) {
    const std::vector<float> distance = distances_along(graph, from, kFar);
    for (const int to : landmarks) sum += distance[static_cast<size_t>(to)];
  }
  return static_cast<float>(sum / (count * count));
}

}  // namespace understudy
