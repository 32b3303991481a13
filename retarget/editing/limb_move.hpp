// A hand or a foot of the result moved by the hand: its limb follows by inverse kinematics,
// kept as rotations.
#pragma once

#include <string>
#include <vector>

#include "retarget/editing/pose_edits.hpp"

namespace understudy {

/// The wrist or ankle that is moved when a joint is dragged: the joint itself, a foot's ankle for its ball;
/// -1 for a joint that ends no limb.
int limb_end(int joint);
/// Whether it ends a leg.
bool is_leg(int joint);
/// The joints that turn when a joint is moved by hand, parent first: shoulder, elbow and wrist; hip, knee,
/// ankle and the ball where that is moved; a joint that ends no limb alone.
std::vector<int> joints_turned_by(int joint);
/// All of them for people: "left arm", "right leg"; of a joint that ends no limb its own label.
std::string limb_label(int joint);

/// A hand or a foot taken along at one frame; the frames around follow less and less (falloff_weight).
struct LimbMove {
  int frame = 0;
  int joint = LeftWrist;       ///< one with a limb_end()
  Vec3 offset = Vec3::Zero();  ///< metres, world
  int falloff = 5;
};

/// What is seen to move at its end: "left hand", "right foot". Throws Error for a joint that ends no limb.
std::string limb_end_label(int joint);

/// The pose with the limb's end moved by an offset, or as far as the limb reaches: the limb keeps the plane
/// it bends in, its end keeps its world rotation, nothing else moves.
/// Throws Error for a joint that ends no limb.
Pose moved_limb(const Joints& rest, int joint, const Vec3& offset, Pose pose);

/// Adds to the rotations what moves the limb in the result as shown, after all other edits but smoothing and
/// pins, which come later and may take some of it back. `performed`: the frame's pose before any edit.
/// Rotations of that frame and falloff that come last for their joints are continued, so that a second drag
/// adds no others. Throws Error as moved_limb().
void add_limb_move(const LimbMove& move, const Pose& performed, const Joints& rest, PoseEdits& edits);

}  // namespace understudy
