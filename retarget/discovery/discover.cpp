#include "retarget/discovery/discover.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/discovery/inner_joints.hpp"
#include "retarget/discovery/keypoint_start.hpp"
#include "retarget/discovery/part_tree.hpp"
#include "retarget/discovery/rest_surface.hpp"
#include "retarget/discovery/rig_figures.hpp"
#include "retarget/discovery/rig_follower.hpp"
#include "retarget/discovery/scan_evidence.hpp"
#include "retarget/discovery/seen_things.hpp"
#include "retarget/discovery/turntables.hpp"
#include "retarget/rig/rig_edits.hpp"

namespace understudy {
namespace {

constexpr int kTrackedPoints = 2000, kSurfacePoints = 6000, kNodes = 200;
constexpr int kKeyFrames = 60;
constexpr double kKeyRate = 12;  // frames/s: what moves between fewer cannot be followed
constexpr int kRounds = 2;       // of parts, bones and tracks: each makes the next better
constexpr uint64_t kSeed = 20240607;
// Joints while they are looked for give a little, then less.
constexpr float kLooseJoints = 0.3f, kFirmJoints = 3;
constexpr float kGuidanceGain = 0.8f;  // keypoints are followed where the surface is then so much nearer
// Shares of the work at which its stages begin.
constexpr float kReadingEnds = 0.1f, kGuidedEnds = 0.25f, kTrackingEnds = 0.5f, kTrackedAgain = 0.7f,
                kBonesEnd = 0.9f;

/// f(i) for 0 .. count - 1 on two threads, a half each.
template <class Function>
void in_halves(size_t count, const Function& f) {
  std::thread first([&] {
    for (size_t i = 0; i < count / 2; ++i) f(i);
  });
  for (size_t i = count / 2; i < count; ++i) f(i);
  first.join();
}

/// Of a single scan keypoints alone tell a skeleton.
void check_count(const ScanSequence& scans, int usable, bool keypoints, const std::string& wrong = {}) {
  const bool one_is_enough = keypoints && scans.count == 1;
  US_CHECK(usable >= 1 || !one_is_enough, scans.name, ": its frame cannot be used", wrong);
  US_CHECK(usable >= 2 || one_is_enough, scans.name,
           ": a skeleton is found in how a thing moves: that takes two frames or more, not ", usable, wrong);
}

/// All frames of a short sequence; else so many from the first on, as far apart as kKeyRate allows.
std::vector<int> key_frames_of(int count, double fps) {
  const int needed = (count + kKeyFrames - 1) / kKeyFrames,
            widest = std::max(1, static_cast<int>(std::floor(fps / kKeyRate)));
  const int stride = std::clamp(needed, 1, widest);
  std::vector<int> frames;
  for (int t = 0; t < count && static_cast<int>(frames.size()) < kKeyFrames; t += stride) frames.push_back(t);
  return frames;
}

/// How far scans are from the tracked surface and it from them, mean over both and the frames, metres.
float tracks_off(const std::vector<ThinnedFrame>& frames, const SurfaceTracks& tracks) {
  std::vector<float> off(frames.size());
  in_halves(frames.size(), [&](size_t t) {
    const PointTree posed(tracks.at(static_cast<int>(t)));
    float to_surface = 0, to_scan = 0;
    for (const auto& p : frames[t].points.rowwise())
      to_surface += std::sqrt(posed.nearest(p.transpose()).squared);
    for (const auto& p : posed.points().rowwise())
      to_scan += std::sqrt(frames[t].tree.nearest(p.transpose()).squared);
    off[t] = to_surface / static_cast<float>(frames[t].points.rows()) +
             to_scan / static_cast<float>(posed.points().rows());
  });
  return std::accumulate(off.begin(), off.end(), 0.0f) / static_cast<float>(2 * off.size());
}

/// The bone of each part.
std::vector<int> bone_of_part(const PartTree& tree) {
  std::vector<int> bone(tree.part_of_bone.size());
  for (size_t b = 0; b < bone.size(); ++b)
    bone[static_cast<size_t>(tree.part_of_bone[b])] = static_cast<int>(b);
  return bone;
}

/// Makes a rig from scans step by step.
class Discovery {
 public:
  Discovery(const ScanSequence& scans, const DiscoveryOptions& options) : scans_(scans), options_(options) {}
  DiscoveredRig run();

 private:
  bool report(const char* stage, float share);
  Mesh scan(int frame) const { return finite_part(scans_.scan(frame)); }
  TrackingProgress tracking_progress(float from, float to);
  void read_key_frames();
  int most_open() const;
  void track();
  void start_from_network();
  DiscoveredRig at_rest();
  void find_bones();
  void show_parts() const;
  void bind_points();
  void fit_all(float stiffness);
  PartJoint joint_as_fitted(int j) const;
  void find_joints_again();
  void drop_still_bones();
  void track_from_bones();
  void follow_others(DiscoveredRig& result, BoneDistances& off);
  void close_surface(Rig& rig) const;
  DiscoveredRig finished();
  void judge_key_frames(DiscoveredRig& result, BoneDistances& off) const;

  const ScanSequence& scans_;
  const DiscoveryOptions& options_;
  std::vector<int> numbers_;          // of the key frames
  std::vector<ThinnedFrame> frames_;  // the key frames
  SurfaceTracks tracks_;
  RigidParts parts_;
  PartTree tree_;
  std::vector<int> keypoint_of_point_;  // of the surface, as the network sees it; empty: no network
  FittedSurface surface_;
  std::vector<BoneMotions> bones_;  // [key frames]
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

void Discovery::read_key_frames() {
  const std::vector<int> wanted = key_frames_of(scans_.count, scans_.fps);
  std::string wrong;
  for (const int t : wanted) {
    try {
      frames_.push_back(thinned(scan(t), kTrackedPoints, kSurfacePoints, kSeed + static_cast<uint64_t>(t)));
      numbers_.push_back(t);
    } catch (const Error& error) {
      wrong = "; frame " + std::to_string(t) + ": " + error.what();
    }
    const float share = static_cast<float>(t) / static_cast<float>(wanted.back() + 1);
    US_CHECK(report("Reading", kReadingEnds * share), scans_.name, ": ended before a skeleton was found");
  }
  check_count(scans_, ssize(frames_), options_.keypoints != nullptr, wrong);
}

int Discovery::most_open() const {
  std::vector<float> open(frames_.size());
  in_halves(frames_.size(), [&](size_t t) { open[t] = openness(frames_[t]); });
  return static_cast<int>(std::max_element(open.begin(), open.end()) - open.begin());
}

/// Each point follows its part, and those of the points about it.
void Discovery::bind_points() {
  const DeformationGraph& graph = tracks_.graph;
  const std::vector<int> bone = bone_of_part(tree_);
  RowMatrix weights = RowMatrix::Zero(graph.points.rows(), tree_.rig.count());
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    const auto own = static_cast<size_t>(parts_.of_point[static_cast<size_t>(i)]);
    weights(i, bone[own]) += 1;
    for (const SurfaceGraph::Edge& edge : graph.surface.edges[static_cast<size_t>(i)])
      weights(i, bone[static_cast<size_t>(parts_.of_point[static_cast<size_t>(edge.to)])]) += 0.5f;
  }
  surface_ = {graph.points, graph.normals, SkinWeights::from(weights)};
}

void Discovery::track() {
  if (!options_.keypoints) {
    tracks_ = track_surface(frames_, most_open(), kNodes, tracking_progress(kReadingEnds, kTrackingEnds));
    return;
  }
  start_from_network();
  if (frames_.size() == 1) return;
  track_again(frames_, tracks_, tracking_progress(kReadingEnds, kGuidedEnds));
  SurfaceTracks alone =
      track_surface(frames_, tracks_.rest_frame, kNodes, tracking_progress(kGuidedEnds, kTrackingEnds));
  // The surface alone tells more where it can be followed.
  if (tracks_off(frames_, tracks_) > kGuidanceGain * tracks_off(frames_, alone)) tracks_ = std::move(alone);
}

/// Shown as the network sees it: all that follows takes longer.
void Discovery::start_from_network() {
  KeypointStart start = start_from_keypoints(frames_, most_open(), kNodes, *options_.keypoints);
  tracks_ = std::move(start.tracks);
  parts_ = std::move(start.parts);
  keypoint_of_point_ = parts_.of_point;
  tree_ = tree_of_keypoints(start.places, options_.keypoints->parents());
  show_parts();
}

/// Of one frame: nothing has moved that could tell where joints are, so they stay where the network
/// sees them.
DiscoveredRig Discovery::at_rest() {
  bind_points();
  bones_.assign(1, BoneMotions(tree_.part_of_bone.size()));
  return finished();
}

void Discovery::find_bones() {
  parts_ = find_rigid_parts(frames_, tracks_, options_.parts);
  tree_ = find_part_tree(tracks_, parts_);
  add_turntables(tracks_, parts_, tree_, options_.parts);
  bind_points();
  bones_.assign(frames_.size(), BoneMotions(tree_.part_of_bone.size()));
  for (size_t t = 0; t < frames_.size(); ++t)
    for (size_t b = 0; b < tree_.part_of_bone.size(); ++b)
      bones_[t][b] = parts_.motions[static_cast<size_t>(tree_.part_of_bone[b])][t];
  show_parts();
}

void Discovery::show_parts() const {
  if (!options_.parts_found) return;
  const std::vector<int> bone = bone_of_part(tree_);
  PartsSoFar so_far{
      numbers_[static_cast<size_t>(tracks_.rest_frame)], tracks_.graph.points, {}, tree_.rig.joints};
  for (const int part : parts_.of_point) so_far.bone_of.push_back(bone[static_cast<size_t>(part)]);
  options_.parts_found(std::move(so_far));
}

void Discovery::fit_all(float stiffness) {
  ArticulatedFitOptions fit;
  fit.first_radius_m = 0.6f * tracks_.graph.spacing;
  fit.last_radius_m = 0.25f * tracks_.graph.spacing;
  fit.joint_stiffness = stiffness;
  in_halves(frames_.size(), [&](size_t t) { fit_bones(tree_.rig, surface_, frames_[t], fit, bones_[t]); });
}

/// The joint that the fitted bones have in common.
PartJoint Discovery::joint_as_fitted(int j) const {
  const RigJoint& joint = tree_.rig.joints[static_cast<size_t>(j)];
  std::vector<RigidMotion> parent, child;
  for (const BoneMotions& bones : bones_) {
    parent.push_back(bones[static_cast<size_t>(joint.parent)]);
    child.push_back(bones[static_cast<size_t>(j)]);
  }
  return find_joint(parent, child, joint.rest, parts_.noise_m, box_diagonal(tracks_.graph.points));
}

/// The joints of bones that have been fitted with joints that give.
void Discovery::find_joints_again() {
  for (int j = 1; j < tree_.rig.count(); ++j) {
    RigJoint& joint = tree_.rig.joints[static_cast<size_t>(j)];
    const PartJoint found = joint_as_fitted(j);
    joint.rest = found.rest;
    if (found.kind != JointKind::Fixed) joint.kind = found.kind, joint.axis = found.axis;
  }
}

/// Bones that by now hardly move against their parents: what tracking had moved.
void Discovery::drop_still_bones() {
  for (int j = tree_.rig.count() - 1; j > 0; --j) {
    if (joint_as_fitted(j).kind != JointKind::Fixed) continue;
    surface_.skin = renumbered(surface_.skin, merge_into_parent(tree_.rig, j));
    tree_.part_of_bone.erase(tree_.part_of_bone.begin() + j);
    for (BoneMotions& bones : bones_) bones.erase(bones.begin() + j);
  }
  for (int j = 0; j < tree_.rig.count(); ++j)
    tree_.rig.joints[static_cast<size_t>(j)].name = "bone " + std::to_string(j);
}

void Discovery::track_from_bones() {
  const std::vector<int> bone = bone_of_part(tree_);
  for (size_t t = 0; t < frames_.size(); ++t)
    for (size_t k = 0; k < tracks_.graph.node_points.size(); ++k) {
      const int part = parts_.of_point[static_cast<size_t>(tracks_.graph.node_points[k])];
      tracks_.motions[t][k] = bones_[t][static_cast<size_t>(bone[static_cast<size_t>(part)])];
    }
  track_again(frames_, tracks_, tracking_progress(kTrackingEnds, kTrackedAgain));
}

void Discovery::judge_key_frames(DiscoveredRig& result, BoneDistances& off) const {
  for (size_t t = 0; t < frames_.size(); ++t) {
    const ScanDistances distances = distances_to(frames_[t], surface_, bones_[t]);
    off.add(surface_.skin, distances);
    result.off_m[static_cast<size_t>(numbers_[t])] = distances.off.mean();
  }
}

/// Frames that are no key frames: from the key frame before them on. What cannot be used repeats the pose
/// before.
void Discovery::follow_others(DiscoveredRig& result, BoneDistances& off) {
  RigFollower follower(result.found.rig);
  std::vector<RigPose>& poses = result.found.motion.poses;
  size_t next = 0;  // key frame
  RigPose last = poses[static_cast<size_t>(numbers_.front())];
  for (int t = 0; t < scans_.count; ++t) {
    RigPose& pose = poses[static_cast<size_t>(t)];
    if (next < numbers_.size() && numbers_[next] == t) {
      follower.start_from(last = pose);
      ++next;
      continue;
    }
    pose = last;
    if (!report("Following",
                kBonesEnd + (1 - kBonesEnd) * static_cast<float>(t) / static_cast<float>(scans_.count)))
      continue;
    try {
      const RigFollower::Followed followed = follower.follow(scan(t));
      pose = last = followed.pose;
      result.off_m[static_cast<size_t>(t)] = followed.off_m();
      off.add(follower.surface().skin, followed.distances);
    } catch (const Error&) {  // no points: repeated
    }
  }
}

/// Clouds that enclose nothing stay a cloud.
void Discovery::close_surface(Rig& rig) const {
  try {
    set_rest_surface({frames_, bones_, surface_}, rig.surface, rig);
  } catch (const Error& error) {
    log::warn(std::string("the found rig's surface stays a cloud: ") + error.what());
  }
}

DiscoveredRig Discovery::finished() {
  DiscoveredRig result;
  result.rest_frame = numbers_[static_cast<size_t>(tracks_.rest_frame)];
  result.key_frames = numbers_;
  Rig& rig = result.found.rig;
  rig = tree_.rig;
  rig.name = "found";
  rig.surface = scan(result.rest_frame);
  rig.skin = weights_between(rig.surface.vertices, surface_.points, surface_.skin, rig.count());
  RigMotion& motion = result.found.motion;
  motion.fps = scans_.fps;
  motion.poses.resize(static_cast<size_t>(scans_.count));
  result.off_m.assign(motion.poses.size(), -1);  // not known
  for (size_t t = 0; t < frames_.size(); ++t) {
    RigPose& pose = motion.poses[static_cast<size_t>(numbers_[t])];
    pose = pose_of(rig, bones_[t]);
    bones_[t] = bone_motions(rig, pose);
  }
  if (rig.surface.is_cloud()) close_surface(rig);
  BoneDistances off(rig.count());
  if (static_cast<int>(frames_.size()) < scans_.count) follow_others(result, off);
  judge_key_frames(result, off);
  measure_motion(result.found, result.bones);
  off.tell(result.bones);
  result.doubted = doubted_frames(result.off_m, box_diagonal(tracks_.graph.points));
  result.complete = goes_on_;
  return result;
}

DiscoveredRig Discovery::run() {
  read_key_frames();
  warn_of_more_than_one(frames_, scans_.name);
  track();
  if (frames_.size() == 1) return at_rest();
  for (int round = 0; round < kRounds; ++round) {
    rest_what_may(frames_, tracks_);
    find_bones();
    if (!goes_on_) return finished();
    fit_all(kLooseJoints);
    find_joints_again();
    if (round + 1 < kRounds) track_from_bones();
  }
  report("Bones", kTrackedAgain);
  fit_all(kFirmJoints);
  find_joints_again();
  drop_still_bones();
  if (options_.keypoints) name_after_keypoints(keypoint_of_point_, surface_.skin, tree_.rig);
  draw_joints_inside(frames_[static_cast<size_t>(tracks_.rest_frame)], tracks_.graph, tree_.rig);
  report("Bones", (kTrackedAgain + kBonesEnd) / 2);
  fit_all(kRigidJoints);
  return finished();
}

}  // namespace

DiscoveredRig discover(const ScanSequence& scans, const DiscoveryOptions& options) {
  check_count(scans, scans.count, options.keypoints != nullptr);
  return Discovery(scans, options).run();
}

}  // namespace understudy
