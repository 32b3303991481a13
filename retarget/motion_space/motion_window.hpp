// A window of motion as the networks of the motion space see it: about its own place and heading, with how
// far each frame is from what is known.
#pragma once

#include <array>
#include <vector>

#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

/// Where a window is looked at from: the place and heading of one of its poses. What is seen from there is
/// the same wherever a motion goes and whichever way.
struct Outlook {
  Vec3 place = Vec3::Zero();  ///< metres
  Mat3 heading = Mat3::Identity();

  static Outlook of(const Pose& pose);
  Pose seen(Pose pose) const;
  std::vector<Pose> seen(std::vector<Pose> poses) const;
  /// The inverse: where in the world a pose is that looks so from here.
  Pose placed(Pose pose) const;
};

constexpr float kWindowRate = 30;    ///< samples/s
constexpr int kLongestWindow = 110;  ///< samples

/// A stretch of a motion, sampled at kWindowRate: a smooth curve through what is known.
struct MotionWindow {
  Joints rest = Joints::Zero();         ///< T-pose joints, metres
  Outlook outlook;                      ///< where it is seen from
  float first = 0, step = 1;            ///< sample i is of frame first + i step of the motion
  std::vector<int> gap_frames;          ///< frames of the motion that are to be made by it
  std::vector<Pose> curve;              ///< of each sample, seen from the outlook
  std::vector<KnownDistance> distance;  ///< of each sample, in samples
};

/// As many windows as all gaps (frames that are not wholly known) need, each with four known samples on
/// both sides, or two dozen where there is but one side. `curve`: the motion with its gaps filled by
/// fill_curves. A gap that does not fit into a window has none.
std::vector<MotionWindow> windows_of(const std::vector<KnownParts>& known, const Motion& curve,
                                     const Joints& rest);

/// What is known of each sample.
std::vector<KnownParts> known_of(const MotionWindow& window);

/// The same in a mirror.
MotionWindow mirrored(const MotionWindow& window);

/// The frame that a window is looked at from: the last that is wholly known before the first that is not, or
/// the first that is wholly known; 0 where none is.
int outlook_frame(const std::vector<KnownParts>& known);

}  // namespace understudy
