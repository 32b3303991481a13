// All keys and commands, to search: shown over everything by H or ?.
// Marks: keys.search, keys.K (a command of the list), keys.close.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// A dialog; call every frame while it is to be seen. False once it was closed. A chosen command that needs
/// nothing more is asked for.
bool draw_keys(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
