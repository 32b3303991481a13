// Finds the skeleton of anything that moves in a sequence of its raw scans.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// How far the work is.
struct DiscoveryProgress {
  const char* stage;  ///< "Surface", "Parts", "Bones", "Skin"
  float share;        ///< 0 .. 1 of all
};

struct DiscoveryOptions {
  int parts = 0;  ///< at most; 0: as many as the motion shows
  /// Called from several threads, one at a time; false ends the work with the best found so far.
  std::function<bool(const DiscoveryProgress&)> progress = {};
};

/// What is known of a bone, for tables.
struct FoundBone {
  float turned_deg = 0;  ///< against its parent, from one end to the other
  float off_m = 0;       ///< of its surface from the scans, mean over frames
};

struct DiscoveredRig {
  RiggedMotion found;  ///< a pose for each frame; the surface is the rest frame's
  int rest_frame = 0;  ///< in which no bone is turned
  std::vector<FoundBone> bones;
  std::vector<float> off_m;   ///< [T] of the surface from the scan, mean over its points, metres
  std::vector<bool> doubted;  ///< [T] frames that the surface does not fit as it does the others
};

/// Tracks the surface of the most open frame through all, joins what moves alike to rigid parts, finds their
/// joints and tree, and fits the rig to the scans: Chang and Zwicker 2011 and Le and Deng 2014 without
/// correspondence. Looks at all frames. The same frames give the same bytes. frames: scans of one thing alone,
/// metres. Throws Error where there are fewer than two frames or a scan has too few points.
DiscoveredRig discover(const std::vector<Mesh>& frames, double fps, const DiscoveryOptions& options = {});

}  // namespace understudy
