#include "ui/panels/arrangement.hpp"

#include <algorithm>
#include <cmath>

#include "ui/panels/bars.hpp"
#include "ui/panels/timeline.hpp"

namespace understudy::ui {
namespace {

constexpr float kNarrow = 760, kEdge = 6;  // at scale 1

/// Cuts a strip off the bottom.
Rect cut_bottom(Rect& from, float height) {
  const float y = std::max(from.min.y, from.max.y - std::round(height));
  const Rect cut{{from.min.x, y}, from.max};
  from.max.y = y;
  return cut;
}

void place_side(Arrangement& places, float scale, const Parts& parts) {
  const float all = places.views.width(), edge = places.narrow ? 0 : std::round(kEdge * scale);
  const float most = places.narrow ? std::max(0.f, all - 24 * scale) : 0.6f * all;
  const float width = std::round(std::min(parts.side_width * scale, most));
  if (width < 60 * scale) return;
  places.side = {{places.views.max.x - width, places.views.min.y}, places.views.max};
  if (places.narrow) return;
  places.side_edge = {{places.side.min.x - edge, places.side.min.y}, {places.side.min.x, places.side.max.y}};
  places.views.max.x = places.side_edge.min.x;
}

}  // namespace

bool is_narrow(float width, float scale) {
  return width < kNarrow * scale;
}

Arrangement arrange(const ImVec2& display, float scale, const Parts& parts) {
  const float high = display.y / scale;
  Arrangement places;
  places.narrow = is_narrow(display.x, scale);
  Rect rest{{0, 0}, display};
  if (high >= 70) {
    places.top = {{0, 0}, {display.x, std::round(kTopBarHeight * scale)}};
    rest.min.y = places.top.max.y;
  }
  if (high >= 250) places.status = cut_bottom(rest, kStatusHeight * scale);
  places.views = rest;
  const float timeline = high >= 430   ? kTimelineHeight
                         : high >= 360 ? kShortTimelineHeight
                                       : kTransportHeight;
  if (parts.timeline && high >= 190) places.timeline = cut_bottom(places.views, timeline * scale);
  if (parts.side) place_side(places, scale, parts);
  const float below = std::min(parts.below_height * scale, 0.5f * places.views.height());
  if (parts.below && below >= 50 * scale) places.below = cut_bottom(places.views, below);
  return places;
}

}  // namespace understudy::ui
