#include "retarget/discovery/discover.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/discovery/articulated_fit.hpp"
#include "retarget/discovery/part_tree.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kTrackedPoints = 2000, kNodes = 200;
constexpr int kRounds = 2;  // of parts, bones and tracks: each makes the next better
constexpr uint64_t kSeed = 20240607;

/// f(i) for 0 .. count - 1 on two threads, each from its own end.
template <class Function>
void in_halves(size_t count, const Function& f) {
  std::thread first([&] {
    for (size_t i = 0; i < count / 2; ++i) f(i);
  });
  for (size_t i = count / 2; i < count; ++i) f(i);
  first.join();
}

std::vector<ThinnedFrame> thinned_frames(const std::vector<Mesh>& frames) {
  std::vector<std::optional<ThinnedFrame>> made(frames.size());
  std::vector<std::string> wrong(frames.size());
  in_halves(frames.size(), [&](size_t t) {
    try {
      made[t] = thinned(frames[t], kTrackedPoints, kSeed + t);
    } catch (const Error& error) {
      wrong[t] = error.what();
    }
  });
  std::vector<ThinnedFrame> thin;
  for (size_t t = 0; t < frames.size(); ++t) {
    US_CHECK(wrong[t].empty(), "frame ", t, ": ", wrong[t]);
    thin.push_back(std::move(*made[t]));
  }
  return thin;
}

int most_open(const std::vector<ThinnedFrame>& frames) {
  std::vector<float> open(frames.size());
  in_halves(frames.size(), [&](size_t t) { open[t] = openness(frames[t]); });
  return static_cast<int>(std::max_element(open.begin(), open.end()) - open.begin());
}

/// Makes a rig from scans step by step.
class Discovery {
 public:
  Discovery(const std::vector<Mesh>& scans, double fps, const DiscoveryOptions& options)
      : scans_(scans), fps_(fps), options_(options), frames_(thinned_frames(scans)) {}
  DiscoveredRig run();

 private:
  bool report(const char* stage, float share);
  TrackingProgress tracking_progress(float from, float to);
  void find_bones();
  void bind_points();
  void fit_all(float stiffness);
  void find_joints_again();
  void track_from_bones();
  DiscoveredRig finished();
  void judge(DiscoveredRig& result) const;
  SkinWeights skin_of(const Points& vertices) const;
  float length(float spacings) const { return spacings * tracks_.graph.spacing; }

  const std::vector<Mesh>& scans_;
  double fps_;
  const DiscoveryOptions& options_;
  std::vector<ThinnedFrame> frames_;
  SurfaceTracks tracks_;
  RigidParts parts_;
  PartTree tree_;
  FittedSurface surface_;
  std::vector<BoneMotions> bones_;  // [T]
  std::vector<float> off_m_;        // [T]
  std::mutex reporting_;
  bool goes_on_ = true;
};

bool Discovery::report(const char* stage, float share) {
  const std::lock_guard<std::mutex> lock(reporting_);
  if (goes_on_ && options_.progress) goes_on_ = options_.progress({stage, share});
  return goes_on_;
}

TrackingProgress Discovery::tracking_progress(float from, float to) {
  return [this, from, to, done = std::make_shared<std::atomic<int>>(0)] {
    const float share = static_cast<float>(++*done) / static_cast<float>(frames_.size());
    return report("Surface", from + (to - from) * share);
  };
}

/// Each point follows the parts of the nodes about it.
void Discovery::bind_points() {
  const DeformationGraph& graph = tracks_.graph;
  std::vector<int> bone(tree_.part_of_bone.size());
  for (size_t b = 0; b < bone.size(); ++b)
    bone[static_cast<size_t>(tree_.part_of_bone[b])] = static_cast<int>(b);
  RowMatrix weights = RowMatrix::Zero(graph.points.rows(), static_cast<Eigen::Index>(bone.size()));
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    for (int k = 0; k < kNodesOfPoint; ++k) {
      const int part = parts_.of_node[static_cast<size_t>(graph.near(i, k))];
      weights(i, bone[static_cast<size_t>(part)]) += graph.shares(i, k);
    }
  surface_ = {graph.points, graph.normals, SkinWeights::from(weights)};
}

void Discovery::find_bones() {
  parts_ = find_rigid_parts(tracks_, options_.parts);
  tree_ = find_part_tree(tracks_, parts_);
  bind_points();
  bones_.assign(frames_.size(), BoneMotions(tree_.part_of_bone.size()));
  for (size_t t = 0; t < frames_.size(); ++t)
    for (size_t b = 0; b < tree_.part_of_bone.size(); ++b)
      bones_[t][b] = parts_.motions[static_cast<size_t>(tree_.part_of_bone[b])][t];
}

void Discovery::fit_all(float stiffness) {
  ArticulatedFitOptions fit;
  fit.first_radius_m = length(0.6f);
  fit.last_radius_m = length(0.25f);
  fit.joint_stiffness = stiffness;
  off_m_.assign(frames_.size(), 0);
  in_halves(frames_.size(),
            [&](size_t t) { off_m_[t] = fit_bones(tree_.rig, surface_, frames_[t], fit, bones_[t]); });
}

/// The joints of bones that have been fitted with joints that give.
void Discovery::find_joints_again() {
  const float size = box_diagonal(tracks_.graph.points);
  for (int j = 1; j < tree_.rig.count(); ++j) {
    RigJoint& joint = tree_.rig.joints[static_cast<size_t>(j)];
    std::vector<RigidMotion> parent, child;
    for (const BoneMotions& bones : bones_) {
      parent.push_back(bones[static_cast<size_t>(joint.parent)]);
      child.push_back(bones[static_cast<size_t>(j)]);
    }
    const PartJoint found = find_joint(parent, child, joint.rest, parts_.noise_m, size);
    joint.rest = found.rest;
    if (found.kind != JointKind::Fixed) joint.kind = found.kind, joint.axis = found.axis;
  }
}

void Discovery::track_from_bones() {
  std::vector<int> bone(tree_.part_of_bone.size());
  for (size_t b = 0; b < bone.size(); ++b)
    bone[static_cast<size_t>(tree_.part_of_bone[b])] = static_cast<int>(b);
  for (size_t t = 0; t < frames_.size(); ++t)
    for (size_t k = 0; k < parts_.of_node.size(); ++k)
      tracks_.motions[t][k] = bones_[t][static_cast<size_t>(bone[static_cast<size_t>(parts_.of_node[k])])];
  track_again(frames_, tracks_, tracking_progress(0.55f, 0.7f));
}

/// Of each vertex: of the tracked points about it, on its side of the surface.
SkinWeights Discovery::skin_of(const Points& vertices) const {
  constexpr int kNear = 6;
  const PointTree tree(surface_.points);
  RowMatrix weights = RowMatrix::Zero(vertices.rows(), tree_.rig.count());
  std::vector<PointTree::Near> near;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    tree.nearest(vertices.row(v).transpose(), kNear, near);
    for (const PointTree::Near& n : near)
      for (int k = 0; k < kSkinBones; ++k)
        weights(v, surface_.skin.bones(n.point, k)) +=
            surface_.skin.weights(n.point, k) / (n.squared + 1e-6f * tracks_.graph.spacing);
  }
  return SkinWeights::from(weights);
}

void Discovery::judge(DiscoveredRig& result) const {
  const Rig& rig = result.found.rig;
  result.bones.resize(rig.joints.size());
  for (const RigPose& pose : result.found.motion.poses)
    for (size_t j = 1; j < rig.joints.size(); ++j)
      result.bones[j].turned_deg =
          std::max(result.bones[j].turned_deg, geodesic_angle(pose.turns[j], Mat3::Identity()) * 180 / kPi);
  result.off_m = off_m_;
  constexpr double kMuch = 2;
  const double usual = percentile({off_m_.begin(), off_m_.end()}, 50);
  for (const float off : off_m_) result.doubted.push_back(off > kMuch * usual);
}

DiscoveredRig Discovery::finished() {
  DiscoveredRig result;
  result.rest_frame = tracks_.rest_frame;
  Rig& rig = result.found.rig;
  rig = tree_.rig;
  rig.name = "found";
  rig.surface = scans_[static_cast<size_t>(tracks_.rest_frame)];
  rig.skin = skin_of(rig.surface.vertices);
  result.found.motion.fps = fps_;
  for (const BoneMotions& bones : bones_) result.found.motion.poses.push_back(pose_of(rig, bones));
  judge(result);
  return result;
}

DiscoveredRig Discovery::run() {
  tracks_ = track_surface(frames_, most_open(frames_), kNodes, tracking_progress(0.05f, 0.5f));
  for (int round = 0; round < kRounds; ++round) {
    find_bones();
    fit_all(0.3f);
    find_joints_again();
    if (round + 1 < kRounds) track_from_bones();
  }
  report("Bones", 0.75f);
  fit_all(3);
  find_joints_again();
  fit_all(1000);
  report("Skin", 0.95f);
  return finished();
}

}  // namespace

DiscoveredRig discover(const std::vector<Mesh>& frames, double fps, const DiscoveryOptions& options) {
  US_CHECK(frames.size() >= 2,
           "a skeleton is found in how a thing moves: that takes two frames or more, not ", frames.size());
  return Discovery(frames, fps, options).run();
}

}  // namespace understudy
