// Rigs of any kind to and from characters: a found rig is a GLB, and opens again. Their motions as BVH.
#pragma once

#include "retarget/character/character.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// One of several motions of a rig, by name.
struct RigClip {
  std::string name;
  RigMotion motion;
};

/// A node a joint, named as it, and one for the surface; one skin; each motion as an animation with a
/// rotation track for each joint that turns, and translations of the root and of sliders. Files keep no kinds
/// of joints: from_character() sees them in the motion. Throws Error for a bad rig, or poses that do not fit.
Character to_character(const Rig& rig, const std::vector<RigClip>& clips);
/// The same with one animation, "motion".
Character to_character(const RiggedMotion& performed);

/// The bones that carry weights or parts, and what those hang on, as a rig in its bind pose, units and axes
/// the file's; all parts as one surface. Above several bones without a common one there is a joint of its
/// own, "root". The motion is the animation, `fps` times a second; -1: the nodes' own pose, one frame.
/// A joint that turns about one line of the parent alone is a Hinge, one that goes along one alone a Slider
/// (three frames show it), others are Balls; a warning tells of what else the file moves (a bone that leaves
/// its parent, morph targets). Of more than four bones of a vertex the four of largest weight count. Throws
/// Error where there is no skin, bones scale, or the animation has more than 100,000 frames.
RiggedMotion from_character(const Character& character, int animation, double fps);

/// The motion alone as BVH, of any tree, see BvhWriter: at rest all angles are zero; the root and sliders
/// have positions. Throws Error for a bad rig, poses that do not fit, and as BvhWriter.
void write_rig_bvh(const std::string& path, const RiggedMotion& performed);

}  // namespace understudy
