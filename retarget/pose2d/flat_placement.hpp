// Where in the picture somebody stands who does what another does in another picture.
#pragma once

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
/// a line. Where feet are not seen, the middle of the body goes as the source's.
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
  std::optional<FlatPose> standing_;
  float leg_;
  bool started_ = false;
  Vec2 from_ = Vec2::Zero(), to_ = Vec2::Zero();  // the same of the middle of the body
  std::optional<Line> feet_;
  float lift_ = 0;  // of the feet's line over the middle's way, as it was when feet were last seen
};

/// All points of a pose, hands and face moved.
void move_pose(const Vec2& way, FlatPose& pose);

}  // namespace understudy
