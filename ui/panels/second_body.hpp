// A section of the panel Bones: the second body, whose bones are whose, its export.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Call while a skeleton is found.
void draw_second_body(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
