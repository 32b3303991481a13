#include "retarget/discovery/scan_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "retarget/base/union_find.hpp"
#include "retarget/discovery/part_tree.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kJudgedFrames = 20;
// What may stand still: off the scans hardly more than where it was tracked to, and a share of the diagonal.
constexpr double kStillSlack = 1.5, kStillOff = 0.001;
constexpr double kStillShare = 0.02;  // of all points: smaller pieces are no piece
constexpr float kTurnOff = 0.005f;    // of the diagonal: how far the axis of a turn may go

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
  of_node.reserve(static_cast<size_t>(graph.count()));
  for (int k = 0; k < graph.count(); ++k) of_node.push_back(motions_of_node(tracks, k));
  const std::vector<RigidMotion> still(tracks.motions.size());
  std::vector<char> may(static_cast<size_t>(graph.points.rows()));
  for (int i = 0; i < static_cast<int>(graph.points.rows()); ++i)
    may[static_cast<size_t>(i)] =
        scans.off(i, still) <= kStillSlack * scans.off(i, of_node[static_cast<size_t>(graph.near(i, 0))]) +
                                   frames * std::pow(kStillOff * size, 2);
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

namespace {

/// Pieces of the surface that may rest, by their points.
std::vector<std::vector<int>> resting_pieces(const SurfaceGraph& surface, const std::vector<char>& may) {
  UnionFind sets(may.size());
  for (size_t i = 0; i < may.size(); ++i)
    for (const SurfaceGraph::Edge& edge : surface.edges[i])
      if (may[i] && may[static_cast<size_t>(edge.to)]) sets.join(static_cast<int>(i), edge.to);
  std::map<int, std::vector<int>> pieces;
  for (size_t i = 0; i < may.size(); ++i)
    if (may[i]) pieces[sets.root(static_cast<int>(i))].push_back(static_cast<int>(i));
  std::vector<std::vector<int>> large;
  for (auto& [root, points] : pieces)
    if (static_cast<double>(points.size()) >= kStillShare * static_cast<double>(may.size()))
      large.push_back(std::move(points));
  return large;
}

/// Whether tracking only turned a piece about an axis that stays where it is. A straight limb that goes along
/// itself may rest in its middle, too, but does not.
bool turns_in_place(const SurfaceTracks& tracks, const std::vector<int>& piece, float size) {
  const Points rest = tracks.graph.points(piece, Eigen::all);
  const Vec3 middle = rest.colwise().mean().transpose();
  const Eigen::VectorXf alike = Eigen::VectorXf::Ones(rest.rows());
  std::vector<RigidMotion> motions;
  for (size_t t = 0; t < tracks.motions.size(); ++t) {
    const Points posed = Points(tracks.at(static_cast<int>(t))(piece, Eigen::all));
    const Vec3 there = posed.colwise().mean().transpose();
    RigidMotion motion;
    motion.R = kabsch(rest.rowwise() - middle.transpose(), posed.rowwise() - there.transpose(), alike);
    motion.t = there - motion.R * middle;
    motions.push_back(motion);
  }
  const PartJoint joint = find_joint(std::vector<RigidMotion>(motions.size()), motions, middle,
                                     static_cast<float>(kStillOff) * size, size);
  return joint.kind == JointKind::Hinge && joint.off_m < kTurnOff * size;
}

}  // namespace

void rest_what_may(const std::vector<ThinnedFrame>& frames, SurfaceTracks& tracks) {
  const DeformationGraph& graph = tracks.graph;
  const float size = box_diagonal(graph.points);
  const ScanEvidence scans(frames, graph);
  const std::vector<char> may = agreed(graph.surface, may_rest(scans, tracks, size));
  std::vector<char> rests(may.size(), 0);
  for (const std::vector<int>& piece : resting_pieces(graph.surface, may))
    if (turns_in_place(tracks, piece, size))
      for (const int point : piece) rests[static_cast<size_t>(point)] = 1;
  for (int k = 0; k < graph.count(); ++k)
    if (rests[static_cast<size_t>(graph.node_points[static_cast<size_t>(k)])])
      for (NodeMotions& motions : tracks.motions) motions[static_cast<size_t>(k)] = {};
}

}  // namespace understudy
