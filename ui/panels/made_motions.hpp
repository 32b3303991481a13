// A section of the panel Bones: further motions of what was found are made, looked at and kept as clips.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Call while a skeleton is found.
void draw_made_motions(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
