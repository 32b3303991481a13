// Poses that a motion has to be in at given frames, and the plain ways between them.
#pragma once

#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

struct PoseKey {
  int frame = 0;
  RigPose pose;
};

/// Throws Error for no frame, keys outside, two of one frame, and poses that do not fit the rig.
void check_keys(const Rig& rig, int frames, const std::vector<PoseKey>& keys);

/// Bends a motion so that it is exactly in each key's pose at its frame. What is missing is spread between
/// keys; before the first and after the last the whole is turned about the vertical and moved, and what else
/// is missing fades within a third of a second. keys: by rising frames.
void meet_keys(const Rig& rig, double fps, const std::vector<PoseKey>& keys, std::vector<RigPose>& poses);

/// Joints about the root of poses that all face +z, [T] of [J, 3].
std::vector<Points> own_places(const Rig& rig, const std::vector<RigPose>& poses);

/// So many frames: between two keys every joint turns the shortest way, evenly, and the root goes straight;
/// before the first and after the last it stands still. keys: by rising frames, at least one.
std::vector<RigPose> slerp_between(const Rig& rig, const std::vector<PoseKey>& keys, int frames);
/// The same with joints that go on straight lines: bones are then turned towards them, as long as they are.
std::vector<RigPose> lerp_between(const Rig& rig, const std::vector<PoseKey>& keys, int frames);

/// The pose whose joints are nearest to `places` [J, 3], metres, root first. Twist that places do not show is
/// that of `like`.
RigPose pose_at_places(const Rig& rig, const Points& places, const RigPose& like);

}  // namespace understudy
