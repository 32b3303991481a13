// How the mouse moves a camera.
#pragma once

#include <optional>

#include "ui/viewport/panes.hpp"

namespace understudy::ui {

/// What the mouse does in a pane in one frame.
struct Pointer {
  ImVec2 at{0, 0}, moved{0, 0};                          ///< pixels; moved since the last frame
  float wheel = 0;                                       ///< notches, > 0 away from the user
  bool over = false;                                     ///< over the pane, and nothing else has the mouse
  bool pressed = false, held = false, released = false;  ///< left button; pressed: over the pane
  bool doubled = false;                                  ///< double click of the left button
  bool turning = false, panning = false;  ///< right, or middle and shift-left, pressed over the pane
};
/// Of the pane's item, just made.
Pointer pointer_of_item();

struct NavigationOptions {
  float sensitivity = 1;
  float scale = 1;  ///< of the interface: pixels a point
};

/// The camera after a drag that turns.
render::Camera orbit_drag(const render::Camera& camera, const ImVec2& moved,
                          const NavigationOptions& options);
/// The camera after a drag that moves it sideways: what is at the target's distance stays under the pointer.
render::Camera pan_drag(const PaneView& view, const ImVec2& moved);
/// The camera after notches of the wheel: what is under the pointer at the target's distance stays there.
render::Camera wheel_zoom(const PaneView& view, const ImVec2& at, float notches);

/// The camera after all that the pointer does in this frame; none when it stays. free_left: the tool leaves
/// the left button to the camera. surface: what a double click has met.
std::optional<render::Camera> navigated(const PaneView& view, const Pointer& pointer, bool free_left,
                                        const NavigationOptions& options);

}  // namespace understudy::ui
