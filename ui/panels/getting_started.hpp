// Getting started: five cards that point at the real widgets, one after the other. No dialog: everything can
// be used meanwhile, and doing what a card says goes on to the next one.
// Marks: guide.card, guide.ring (around what it points at), guide.next, guide.skip.
#pragma once

#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct GettingStartedState {
  int card = -1;  ///< the one that `before` belongs to; below 0: nothing was drawn yet
  /// What was there when the card came.
  struct Before {
    app::Document document;
    std::vector<app::CameraState> cameras;
    int64_t notices_made = 0;
  } before;
  float height = 0;  ///< of the card's window, pixels
};

/// Call in every frame, outside any window. Shows the card that the settings name, unless it is `hidden`, and
/// asks for the next one when the person has done what it says.
void draw_getting_started(const app::Session& session, PanelContext& context, GettingStartedState& state,
                          bool hidden);

}  // namespace understudy::ui
