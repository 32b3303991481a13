// The map of motions while it is open: what is on it, what was asked of it.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/motion_space/motion_map.hpp"

namespace understudy::app {

/// A step that the targets perform as long as it is pointed at.
struct StepPerformance {
  int step = 0;
  double since = 0;  ///< Session::time
  float fps = 30;
  /// A frame of a target.
  struct Frame {
    Pose pose;
    Joints joints;
  };
  std::vector<std::vector<Frame>> takes;  ///< of each take, equally long; empty: it has no target yet

  /// The number of the frame at a time of the session; it begins again after the last.
  int frame_at(double time, size_t take) const;
};

struct MapState {
  std::array<std::shared_ptr<const MotionMap>, 2> maps;  ///< by MapOf
  MapOf shown = MapOf::Steps;
  std::shared_ptr<const MotionMap> map;  ///< that of what is shown; null: nothing was indexed
  MapColour colour = MapColour::Action;
  std::shared_ptr<const MapColouring> colouring;  ///< of the map, by `colour`
  std::string words;                              ///< what is on it, one sentence
  int64_t job = 0;                                ///< that reads motions; 0: none

  std::vector<NearStep> like;  ///< the likest first
  std::string like_what;       ///< "frames 12 to 45"; empty: it was not asked
  /// The place that was decoded last, and what lies there.
  struct Decoded {
    MapPlace place;
    MapBlend blend;
  };
  std::optional<Decoded> decoded;
  std::optional<StepPerformance> performance;

  /// Whether there is something to look at.
  bool any() const { return map && map->size() > 0; }
  bool any_of_both() const {
    return std::any_of(maps.begin(), maps.end(), [](const auto& one) { return one && one->size() > 0; });
  }
};

}  // namespace understudy::app
