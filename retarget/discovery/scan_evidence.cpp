#include "retarget/discovery/scan_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/union_find.hpp"

namespace understudy {
namespace {

constexpr int kJudgedFrames = 20;
// What may stand still: off the scans hardly more than where it was tracked to, and a share of the diagonal.
constexpr double kStillSlack = 1.5, kStillOff = 0.001;
constexpr double kStillShare = 0.02;   // of all points: smaller pieces are no piece
constexpr double kStillMoved = 0.004;  // of the diagonal: what tracking moved less needs no rest

std::vector<RigidMotion> motions_of_node(const SurfaceTracks& tracks, int node) {
  std::vector<RigidMotion> motions;
  for (const NodeMotions& frame : tracks.motions) motions.push_back(frame[static_cast<size_t>(node)]);
  return motions;
}

/// Of each point whether the scans see it as well where it was at rest, in all frames.
std::vector<char> may_rest(const ScanEvidence& scans, const SurfaceTracks& tracks, double size) {
  const DeformationGraph& graph = tracks.graph;
  const double frames = static_cast<double>(tracks.motions.size());
  std::vector<std::vector<RigidMotion>> of_node;
  for (int k = 0; k < graph.count(); ++k) of_node.push_back(motions_of_node(tracks, k));
  const std::vector<RigidMotion> still(tracks.motions.size());
  std::vector<char> may;
  for (int i = 0; i < static_cast<int>(graph.points.rows()); ++i)
    may.push_back(scans.off(i, still) <=
                  kStillSlack * scans.off(i, of_node[static_cast<size_t>(graph.near(i, 0))]) +
                      frames * std::pow(kStillOff * size, 2));
  return may;
}

/// Most of the neighbours say so, too.
std::vector<char> agreed(const SurfaceGraph& surface, const std::vector<char>& may) {
  std::vector<char> most;
  for (size_t i = 0; i < may.size(); ++i) {
    int yes = may[i];
    for (const SurfaceGraph::Edge& edge : surface.edges[i]) yes += may[static_cast<size_t>(edge.to)];
    most.push_back(2 * yes > static_cast<int>(surface.edges[i].size()) + 1);
  }
  return most;
}

}  // namespace

ScanEvidence::ScanEvidence(const std::vector<ThinnedFrame>& frames, const DeformationGraph& graph)
    : frames_(frames), graph_(graph) {
  const auto count = static_cast<int>(frames.size()), used = std::min(count, kJudgedFrames);
  for (int k = 0; k < used; ++k) judged_.push_back(k * count / used);
  share_ = static_cast<double>(count) / used;
  const float most = 0.5f * graph_.spacing;
  most_ = most * most;
}

double ScanEvidence::off(int point, const std::vector<RigidMotion>& motions) const {
  const Vec3 x = graph_.points.row(point).transpose(), n = graph_.normals.row(point).transpose();
  double sum = 0;
  for (const int t : judged_) {
    const RigidMotion& motion = motions[static_cast<size_t>(t)];
    const ThinnedFrame& scan = frames_[static_cast<size_t>(t)];
    const Vec3 y = motion(x);
    const PointTree::Near near = scan.tree.nearest(y);
    const Vec3 normal = scan.normals.row(near.point).transpose();
    const float along = normal.dot(y - scan.points.row(near.point).transpose());
    const bool faces = normal.dot(motion.R * n) > 0.2f && near.squared < 4 * most_;
    sum += faces ? std::min(along * along, most_) : most_;
  }
  return share_ * sum;
}

void rest_what_may(const std::vector<ThinnedFrame>& frames, SurfaceTracks& tracks) {
  const DeformationGraph& graph = tracks.graph;
  const double size = box_diagonal(graph.points);
  const ScanEvidence scans(frames, graph);
  const std::vector<char> may = agreed(graph.surface, may_rest(scans, tracks, size));
  UnionFind pieces(may.size());
  for (size_t i = 0; i < may.size(); ++i)
    for (const SurfaceGraph::Edge& edge : graph.surface.edges[i])
      if (may[i] && may[static_cast<size_t>(edge.to)]) pieces.join(static_cast<int>(i), edge.to);
  std::vector<int> sizes(may.size(), 0);
  std::vector<double> moved(may.size(), 0);
  for (size_t i = 0; i < may.size(); ++i) ++sizes[static_cast<size_t>(pieces.root(static_cast<int>(i)))];
  for (size_t t = 0; t < tracks.motions.size(); ++t) {
    const Points posed = tracks.at(static_cast<int>(t));
    for (Eigen::Index i = 0; i < posed.rows(); ++i)
      moved[static_cast<size_t>(pieces.root(static_cast<int>(i)))] +=
          (posed.row(i) - graph.points.row(i)).squaredNorm();
  }
  for (int k = 0; k < graph.count(); ++k) {
    const int point = graph.node_points[static_cast<size_t>(k)];
    const auto piece = static_cast<size_t>(pieces.root(point));
    const double far = std::sqrt(moved[piece] / (sizes[piece] * static_cast<double>(frames.size())));
    if (!may[static_cast<size_t>(point)] || sizes[piece] < kStillShare * static_cast<double>(may.size()) ||
        far < kStillMoved * size)
      continue;
    for (NodeMotions& motions : tracks.motions) motions[static_cast<size_t>(k)] = {};
  }
}

}  // namespace understudy
