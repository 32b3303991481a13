// The settings dialog.
// Marks: settings.theme(.0, .1), settings.scale, settings.samples, settings.cache, settings.autosave,
// settings.undo_depth, settings.mouse, settings.close.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// A dialog; call every frame while it is open. False once closed.
bool draw_settings(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
