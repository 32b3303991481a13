// The cube in the corner of a view that shows where it looks from: a click on a face looks from there.
#pragma once

#include <optional>

#include "render/camera.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// Where the cube of a view is; none where there is no room.
std::optional<Rect> cube_place(const Ui& ui, const Rect& view);
/// The face under a pixel, as app::kViewPresets begins; -1 for none.
int cube_face_at(const Rect& place, const render::Camera& camera, const ImVec2& at);
/// Draws it into the current window; marks NAME, and NAME.front ... the faces that are seen.
void draw_cube(Ui& ui, const std::string& name, const Rect& place, const render::Camera& camera, int hovered);

}  // namespace understudy::ui
