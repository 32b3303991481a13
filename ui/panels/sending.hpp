// The dialog that sends what is shown to an engine.
// Marks: send.protocol(.0, .1), send.address, send.on, send.state, send.close.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Call every frame while it is open. False once closed; sending goes on.
bool draw_sending(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
