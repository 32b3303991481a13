// The ground that people stand on.
#pragma once

#include <optional>

#include "retarget/geometry/cells.hpp"
#include "retarget/geometry/floor_plane.hpp"

namespace understudy {

struct Ground {
  FloorPlane plane;
  float thickness_m = 0.02f;  ///< what is no higher above the plane is ground: noise makes it thicker
  float area_m2 = 0;          ///< of what is seen of it with nothing above
};

/// Finds the ground in a stream of scans, y up: a plane tilted by at most 15 degrees with hardly anything
/// below and bare places of 0.15 square metres at least; any size, noisy, seen from one side. Of stairs the
/// lowest step. A ground once found stays, slowly following what is seen of it. Deterministic; looks only
/// back, memory is constant.
class GroundFinder {
 public:
  void restart() { ground_.reset(); }
  /// The ground after one more scan; none so far: none. Cells of about 5 cm.
  const std::optional<Ground>& push(const Cells& cells);
  const std::optional<Ground>& last() const { return ground_; }

 private:
  std::optional<Ground> ground_;
};

}  // namespace understudy
