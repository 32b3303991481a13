// The command that renders the clips of the open study.
#pragma once

#include "app/session/commands.hpp"

namespace understudy::app {

/// study.render, as a job with its progress.
void add_study_render(Commands& commands);

}  // namespace understudy::app
