// What the views show: layers and colours of the source and the takes, cameras.
// Marks, P being source or take: layers.P.surface, .as_points, .skeleton, .x_ray, .joint_names, .ground,
// .trails, .ghosts, .colour; layers.weights_joint, layers.trail_joint, layers.trail.JOINT,
// layers.ghost_count, layers.ghost_step, layers.error_scale; layers.preset.NAME, layers.fit, layers.ortho,
// layers.linked, layers.follow, layers.turntable. Sections: layers.source, layers.take, layers.colours,
// layers.camera.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

void draw_layers(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
