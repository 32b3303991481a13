// The map of motions: its view of the plane, and small figures.
// Marks: map.index, map.color, map.canvas, map.step.N (steps that have a figure), map.preview, map.like_this,
// map.like (.K: the K-th of what is alike).
#pragma once

#include <vector>

#include "retarget/motion_space/motion_map.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Where the plane is looked at, and what is drawn of it.
struct MapView {
  MapPlace centre = MapPlace::Zero();
  float zoom = 0, least_zoom = 0;  ///< pixels a unit
  std::vector<int> dots;     ///< steps that are seen as points: where many lie on each other one of them
  std::vector<int> figures;  ///< steps that are seen as figures, where there is room

  /// All of the map in this place.
  void fit(const MotionMap& map, const Rect& place);
  /// Finds what is drawn.
  void thin(const MotionMap& map, const Rect& place, float figure_height);
  ImVec2 on_screen(const MapPlace& at, const Rect& place) const;
  MapPlace on_map(const ImVec2& at, const Rect& place) const;
  /// The step nearest to a place of the screen, -1 where none is within so many pixels.
  int step_at(const MotionMap& map, const ImVec2& at, const Rect& place, float within) const;
};

/// What the panel keeps between frames.
struct MotionMapState {
  std::shared_ptr<const MotionMap> map;  ///< that `view` is of
  MapView view;
  Rect place;           ///< of the map in the last frame
  float scale = 0;      ///< of the interface then
  bool stale = true;    ///< what is drawn is to be found anew
  int hovered = -1;     ///< step under the pointer
  float performed = 0;  ///< seconds that it has been performing
};

/// A person of capsules: far limbs paler. `at`: where the floor below the origin is.
struct FigureLook {
  ImVec2 at;
  float pixels_a_metre = 40;
  ImVec4 color, far_color;
};
void draw_figure(ImDrawList& list, const Joints& joints, const FigureLook& look);

}  // namespace understudy::ui
