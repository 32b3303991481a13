// Finds the skeleton of anything that moves in a sequence of its raw scans.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// Scans of one thing alone, in the order of time, read when they are asked for.
struct ScanSequence {
  std::string name = "the scans";  ///< for messages: a path
  int count = 0;
  double fps = 30;
  std::function<Mesh(int)> scan;  ///< by number, on one thread; empty: the frame cannot be used
};

/// How far the work is.
struct DiscoveryProgress {
  const char* stage;  ///< "Reading", "Surface", "Bones", "Following"
  float share;        ///< 0 .. 1 of all
};

/// What is known while the work goes on: to be drawn.
struct PartsSoFar {
  int rest_frame = 0;
  Points points{0, 3};         ///< [N, 3] of the surface, where they are in the rest frame
  std::vector<int> bone_of;    ///< [N]
  std::vector<RigJoint> tree;  ///< at rest; without names
};

struct DiscoveryOptions {
  int parts = 0;  ///< at most; 0: as many as the motion shows
  /// Null: bones are found in the motion alone. Else this network's keypoints tell where the surface goes
  /// where it moves too far between two frames to be followed by itself, and bones are named after those that
  /// own them, alike in all bodies of the kind. One frame is enough: its bones are the keypoints, joined as
  /// in all of the kind.
  std::shared_ptr<KeypointFinder> keypoints = nullptr;
  /// Called each time bones have been looked for, on one thread; with keypoints at once, as they were seen.
  std::function<void(PartsSoFar)> parts_found = {};
  /// Called from several threads, one at a time; false ends the work with the best found so far.
  std::function<bool(const DiscoveryProgress&)> progress = {};
};

/// What is known of a bone, for tables.
struct FoundBone {
  float turned_deg = 0;  ///< against its parent, furthest from rest
  float slid_m = 0;      ///< of a slider
  float off_m = -1;      ///< of its surface from the scans, mean over the frames; -1: not known
  /// Of the frames those in which scans show its surface (see BoneDistances), 0 .. 1; -1: not known.
  float seen_share = -1;
};

struct DiscoveredRig {
  /// A pose for each frame; the surface is the rest frame's scan, of clouds a closed one.
  RiggedMotion found;
  int rest_frame = 0;            ///< in which no bone is turned
  std::vector<int> key_frames;   ///< that the skeleton was found in; the others were followed
  std::vector<FoundBone> bones;  ///< one a joint
  std::vector<float> off_m;      ///< [T] of the surface from the scan, mean over its points, metres
  std::vector<bool>
      doubted;           ///< [T] frames that it fits clearly worse than the others, or that could not be used
  bool complete = true;  ///< false: ended early
  /// No motion has shown its joints: they are where a network's keypoints are in one frame.
  bool seen_once() const { return key_frames.size() == 1; }
  int first_frame = 0;  ///< of the scans: the first pose's, where edits have trimmed it
};

/// Tracks the surface of the most open frame through up to 60 key frames, joins what moves alike to rigid
/// parts, finds their joints and tree, and fits the rig to the scans; other frames are followed. After Chang
/// and Zwicker 2011 and Le and Deng 2014, without correspondence. Looks at all frames, unlike RigFollower.
/// Of one frame with keypoints the rig at rest. The same scans give the same bytes. Throws Error naming the
/// scans where too few frames can be used (two; of a single scan, with keypoints, that one), and where it is
/// ended before a skeleton was found. Warns of scans that seem to show more than one thing.
DiscoveredRig discover(const ScanSequence& scans, const DiscoveryOptions& options = {});

}  // namespace understudy
