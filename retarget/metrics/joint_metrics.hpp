// Errors of joints and rotations against the truth, and figures of a motion without truth.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// One body's joints over time, world, metres.
using JointSequence = std::vector<Joints>;
/// Of each joint whether the scan shows it, 0..1: from one half on it is seen.
using SeenJoints = Eigen::Array<float, kJointCount, 1>;

// With truth. Both sequences must be equally long and not empty, otherwise Error. Sums are kept in double.

/// Mean over frames and joints of |p - q|, metres.
double mean_joint_error(const JointSequence& predicted, const JointSequence& truth);
/// The same of those joints that are seen; NaN where none is. `seen` has a frame for each of both.
double seen_joint_error(const JointSequence& predicted, const JointSequence& truth,
                        const std::vector<SeenJoints>& seen);
/// Share of frames and joints of which it is said rightly whether they are seen.
double visibility_right(const std::vector<SeenJoints>& predicted, const std::vector<SeenJoints>& truth);
/// Each frame's prediction after the best similarity (rotation, translation, scale) onto the truth of that
/// frame.
JointSequence aligned_joints(const JointSequence& predicted, const JointSequence& truth);
/// Each frame's prediction moved onto the truth by the middle of its hips, then scaled about it as fits best.
JointSequence scaled_joints(const JointSequence& predicted, const JointSequence& truth);
/// Mean over frames and joints of |D2 p - D2 q|, D2 the second difference at 30 frames/s; metres per frame
/// squared. Sequences at another rate are resampled linearly first. NaN with fewer than 3 frames at 30
/// frames/s.
double acceleration_error(const JointSequence& predicted, const JointSequence& truth, double fps);
/// The sequence at another rate, linear between frames; both ends stay inside the original.
JointSequence resampled(const JointSequence& joints, double from_fps, double to_fps);

/// Share of frames and limbs (both arms, both legs) in which exchanging left and right lowers the error.
double swap_rate(const JointSequence& predicted, const JointSequence& truth);
/// Share of frames whose hip line points more than 90 degrees away from the true one.
double flip_rate(const JointSequence& predicted, const JointSequence& truth);

/// Mean angle between predicted and true world rotations in degrees, of all joints and of some.
struct RotationError {
  double all_deg = 0, head_deg = 0, wrist_deg = 0, foot_deg = 0;
};
/// Frames of local rotations; equally many of both, at least one.
RotationError rotation_error(const std::vector<Rotations>& predicted, const std::vector<Rotations>& truth);

// Without truth.

/// Mean over bones of (standard deviation of the bone's length over time / its mean length).
double bone_drift(const JointSequence& joints);
/// Mean horizontal speed, m/s, of a foot joint while it is within 5 cm of the floor (y = 0) in both of two
/// neighbouring frames. NaN when no foot ever is.
double foot_skate(const JointSequence& joints, double fps);
/// Mean over frames and joints of the length of the third derivative of position, m/s^3. NaN with fewer than
/// 4 frames.
double jerk(const JointSequence& joints, double fps);

}  // namespace understudy
