#include "retarget/discovery/keypoint_start.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kTurnedTogether = 0.12f;  // of the diagonal: keypoints about one that turn as it does

std::vector<FoundKeypoints> keypoints_in(const std::vector<ThinnedFrame>& frames, KeypointFinder& finder) {
  std::vector<Mesh> scans;
  scans.reserve(frames.size());
  for (const ThinnedFrame& frame : frames) scans.push_back({frame.points, Faces(0, 3)});
  return finder.find(scans);
}

/// How the keypoints about one have turned since `rest`, the nearer the more.
Mat3 turn_about(const Points& rest, const Points& now, Eigen::Index k, float reach) {
  Mat3 sum = 1e-6f * reach * reach * Mat3::Identity();
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const Eigen::RowVector3f was = rest.row(i) - rest.row(k), is = now.row(i) - now.row(k);
    sum += std::exp(-was.squaredNorm() / (2 * reach * reach)) * is.transpose() * was;
  }
  return nearest_rotation(sum);
}

/// Where keypoint k takes what is about it, from the rest frame.
RigidMotion motion_of(const FoundKeypoints& rest, const FoundKeypoints& now, int k, float size) {
  const auto i = static_cast<size_t>(k);
  const Mat3 R = now.turns.empty() ? turn_about(rest.places, now.places, k, kTurnedTogether * size)
                                   : Mat3(now.turns[i] * rest.turns[i].transpose());
  return {R, now.places.row(k).transpose() - R * rest.places.row(k).transpose()};
}

/// Whose each point is; every keypoint owns one.
std::vector<int> owners_of(const Points& points, const FoundKeypoints& found) {
  std::vector<int> owner(static_cast<size_t>(points.rows()));
  const Eigen::Index K = found.places.rows();
  std::vector<int> owned(static_cast<size_t>(K), 0);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    Eigen::Index nearest;
    (found.places.rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    const auto at = static_cast<size_t>(i);
    owner[at] = found.owner.empty() ? static_cast<int>(nearest) : found.owner[at];
    ++owned[static_cast<size_t>(owner[at])];
  }
  for (Eigen::Index k = 0; k < K; ++k) {
    if (owned[static_cast<size_t>(k)] > 0) continue;
    Eigen::VectorXf squared = (points.rowwise() - found.places.row(k)).rowwise().squaredNorm();
    for (size_t i = 0; i < owner.size(); ++i)  // nobody else's last
      if (owned[static_cast<size_t>(owner[i])] < 2) squared[static_cast<Eigen::Index>(i)] = 1e30f;
    Eigen::Index nearest;
    squared.minCoeff(&nearest);
    --owned[static_cast<size_t>(owner[static_cast<size_t>(nearest)])];
    owner[static_cast<size_t>(nearest)] = static_cast<int>(k);
    ++owned[static_cast<size_t>(k)];
  }
  return owner;
}

std::string keypoint_name(int k) {
  return "keypoint " + std::to_string(k + 1);
}

}  // namespace

KeypointStart start_from_keypoints(const std::vector<ThinnedFrame>& frames, int rest_frame, int nodes,
                                   KeypointFinder& finder) {
  const std::vector<FoundKeypoints> found = keypoints_in(frames, finder);
  const FoundKeypoints& rest = found[static_cast<size_t>(rest_frame)];
  const ThinnedFrame& frame = frames[static_cast<size_t>(rest_frame)];
  KeypointStart start;
  start.tracks = {deformation_graph(frame, nodes), rest_frame, {}};
  start.places = rest.places;
  const DeformationGraph& graph = start.tracks.graph;
  const float size = box_diagonal(graph.points);
  FoundKeypoints shown = rest;  // the graph has the frame's first points
  if (!shown.owner.empty()) shown.owner.resize(static_cast<size_t>(graph.points.rows()));
  start.parts.of_point = owners_of(graph.points, shown);
  const int count = static_cast<int>(rest.places.rows());
  start.parts.motions.resize(static_cast<size_t>(count));
  for (int k = 0; k < count; ++k)
    for (const FoundKeypoints& now : found)
      start.parts.motions[static_cast<size_t>(k)].push_back(motion_of(rest, now, k, size));
  for (size_t t = 0; t < frames.size(); ++t) {
    NodeMotions motions;
    for (const int point : graph.node_points)
      motions.push_back(
          start.parts.motions[static_cast<size_t>(start.parts.of_point[static_cast<size_t>(point)])][t]);
    start.tracks.motions.push_back(std::move(motions));
  }
  return start;
}

PartTree tree_of_keypoints(const Points& places, const std::vector<int>& parents) {
  PartTree tree;
  std::vector<int> bone(parents.size(), -1);
  const auto add = [&](size_t k) {
    const int parent = parents[k] < 0 ? -1 : bone[static_cast<size_t>(parents[k])];
    bone[k] = tree.rig.count();
    tree.rig.joints.push_back({keypoint_name(static_cast<int>(k)), parent,
                               parent < 0 ? JointKind::Free : JointKind::Ball,
                               places.row(static_cast<Eigen::Index>(k)).transpose(), Vec3::UnitY()});
    tree.part_of_bone.push_back(static_cast<int>(k));
  };
  for (size_t k = 0; k < parents.size(); ++k)
    if (parents[k] < 0) add(k);
  for (size_t at = 0; at < tree.part_of_bone.size(); ++at)
    for (size_t k = 0; k < parents.size(); ++k)
      if (parents[k] == tree.part_of_bone[at]) add(k);
  return tree;
}

void name_after_keypoints(const std::vector<int>& keypoint_of_point, const SkinWeights& skin, Rig& rig) {
  const int keypoints = 1 + *std::max_element(keypoint_of_point.begin(), keypoint_of_point.end());
  RowMatrix shared = RowMatrix::Zero(rig.count(), keypoints);
  const RowMatrix weights = skin.dense(rig.count());
  for (size_t i = 0; i < keypoint_of_point.size(); ++i)
    shared.col(keypoint_of_point[i]) += weights.row(static_cast<Eigen::Index>(i)).transpose();
  for (int named = 0; named < std::min(rig.count(), keypoints); ++named) {
    Eigen::Index bone, keypoint;
    if (shared.maxCoeff(&bone, &keypoint) <= 0) return;
    rig.joints[static_cast<size_t>(bone)].name = keypoint_name(static_cast<int>(keypoint));
    shared.row(bone).setZero(), shared.col(keypoint).setZero();
  }
}

}  // namespace understudy
