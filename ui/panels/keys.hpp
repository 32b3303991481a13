// The searchable list of all keys and commands, opened by H or ?.
// Marks: keys.search, keys.K (a command of the list), keys.close.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// A dialog; call every frame while it is open. False once closed. Pushes a chosen command that needs no
/// arguments.
bool draw_keys(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
