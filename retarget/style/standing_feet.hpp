// Keeps the standing feet of a styled pose where they stand.
#pragma once

#include <array>

#include "retarget/style/foot_points.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy {

/// Online, of constant memory. The pelvis of a styled pose can follow one standing foot; where two stand and
/// the style turned the legs, both would slide. While a foot of the source stands, its ankle moves as the
/// source's does, by hip and knee; what this has moved it is given up as it swings.
class StandingFeet {
 public:
  void reset() { *this = StandingFeet(); }
  /// Turns the legs of `styled` (world), of a frame with these feet.
  void push(const StyleFrame& source, const StyledFeet& feet, Pose& styled);

 private:
  // Of the frame before:
  StyledFeet last_;
  Vec3 last_root_ = Vec3::Zero();                             // of the styled pose
  std::array<Vec3, 2> moved_ = {Vec3::Zero(), Vec3::Zero()};  ///< of each ankle
  bool started_ = false;
};

}  // namespace understudy
