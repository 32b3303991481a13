// Where in the picture somebody stands who does what another does in another picture.
#pragma once

#include <array>
#include <optional>

#include "retarget/base/fields.hpp"
#include "retarget/keypoints/proportions.hpp"

namespace understudy {

enum class FlatPlace {
  Reference,  ///< starts where the target stands in its own picture, as large as there
  Source      ///< where the source stands, in its size
};
constexpr Names<2> kFlatPlaceNames{"reference", "source"};

/// Online. The lowest point of the feet goes as the source's does, in lengths of the legs: feet's line stays
/// a line. Where feet are not seen, the middle of the body goes as the source's: the mid-hip, without one the
/// neck, without both as it went last.
class FlatPlacement {
 public:
  /// standing: the target in its own picture; none: it starts where the source stands.
  FlatPlacement(const std::optional<FlatPose>& standing, float target_leg);
  /// Moves `pose` to its place. source: what it was made of; source_leg: pixels.
  void push(const FlatPose& source, float source_leg, FlatPose& pose);

 private:
  struct Line {
    float from = 0, to = 0;  // where the source's feet were when first seen, and the result's
  };
  struct Anchor {
    Vec2 from, to;  // where a point of the source was when first seen, and the result's
  };
  void start(const FlatPose& source, const FlatPose& pose);
  Vec2 way_of(const FlatPose& source, float ratio, const FlatPose& pose);

  std::optional<FlatPose> standing_;
  float leg_;
  bool started_ = false;
  std::array<std::optional<Anchor>, 2> anchors_;  // mid-hip and neck
  Vec2 way_ = Vec2::Zero();                       // as it was when any of them was last seen
  std::optional<Line> feet_;
  float lift_ = 0;  // of the feet's line over the middle's way, as it was when feet were last seen
};

/// Ankles, heels and toes become missing.
void forget_feet(FlatPose& pose);
/// All points of a pose, hands and face moved.
void move_pose(const Vec2& way, FlatPose& pose);
/// All of them so many times as far from the mid-hip; without one from the neck, without both from the middle
/// of what is seen.
void scale_pose(float times, FlatPose& pose);

}  // namespace understudy
