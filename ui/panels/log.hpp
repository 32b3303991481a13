// The log: what the program told, newest last.
// Marks: log.warnings (filter), log.copy, log.clear, log.close, log.lines.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct LogState {
  bool warnings_only = false;
  size_t seen = 0;  ///< lines drawn last, to stay at the end as it grows
};

void draw_log(const app::Session& session, PanelContext& context, LogState& state);

}  // namespace understudy::ui
