// The map of motions while it is open: what is on it, what was asked of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/motion_space/motion_map.hpp"

namespace understudy::app {

struct MapState {
  std::shared_ptr<const MotionMap> map;  ///< null: nothing was indexed
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

  /// Whether there are steps to look at.
  bool any() const { return map && map->size() > 0; }
};

}  // namespace understudy::app
