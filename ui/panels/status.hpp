// The status line: running jobs and their progress, the last message, frames per second.
// Marks: status.job (with status.job.cancel), status.more_jobs, status.message (opens the log),
// status.document, status.rate.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

constexpr float kStatusHeight = 36;  ///< at scale 1

/// Fills the current window. `frame_rate`: of the window, frames per second; 0: not known.
void draw_status(const app::Session& session, PanelContext& context, float frame_rate);

}  // namespace understudy::ui
