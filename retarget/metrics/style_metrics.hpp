// Figures of how a motion is performed, whatever is done. Joints in the world, metres. All but those of
// flights and standing feet are of joints smoothed by a Gaussian of 0.05 s, so that the noise of one capture
// is not taken for the life of another.
#pragma once

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {

/// The range of the neck over the pelvis, degrees: how far it leans sideways and forward in the body's own
/// heading, from the least to the most, both together (the hypotenuse). NaN with fewer than 2 frames.
double body_sway_deg(const JointSequence& joints, double fps);
/// Speed at which the head turns on the chest from each frame to the next, degrees/s: one fewer than frames.
/// Local rotations.
std::vector<float> head_turns_deg_s(const std::vector<Rotations>& local, double fps);
/// Their mean; NaN with fewer than 2 frames.
double head_turn_deg_s(const std::vector<Rotations>& local, double fps);
/// Speed of the pelvis from each frame to the next, lengths of the legs a second.
std::vector<float> pelvis_speeds_legs(const JointSequence& joints, double fps);
/// Their mean; NaN with fewer than 2 frames.
double pelvis_speed_legs(const JointSequence& joints, double fps);
/// How far apart two places of the acting wrist (the one that is fastest at some time) are at most, beside
/// the pelvis, over its top speed: seconds. NaN where no wrist moves.
double rise_s(const JointSequence& joints, double fps);
/// What pulls the body down in flights, m/s^2: the median over flights of the parabola through the mean joint
/// height. A flight is 0.15 s or longer with both feet off the floor. NaN without one.
double flight_gravity(const JointSequence& joints, double fps);
/// The period that dominates the ankles' way past each other, 0.3 to 3 s, from its autocorrelation. NaN where
/// none repeats (below 0.4).
double cycle_s(const JointSequence& joints, double fps);
/// Mean speed over the floor, m/s, of the balls of feet that stand (ContactSwitch) in two neighbouring
/// frames. NaN where none does.
double stance_slide(const JointSequence& joints, double fps);

}  // namespace understudy
