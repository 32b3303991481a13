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
  /// Turns the legs of `styled` (world). bears: how much each point of the feet bears (StyledRoot::bears).
  void push(const StyleFrame& source, const FootPoints<float>& bears, Pose& styled);

 private:
  /// Of the frame before, world.
  FootPoints<Vec3> source_, styled_;
  FootPoints<float> bore_{};
  std::array<Vec3, 2> moved_ = {Vec3::Zero(), Vec3::Zero()};  ///< of each ankle
  bool started_ = false;
};

}  // namespace understudy
