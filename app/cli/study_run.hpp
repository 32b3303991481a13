// `understudy study run`: shows a study to a participant.
#pragma once

#include <memory>

#include "app/cli/commands.hpp"

namespace understudy::app {

void add_study_run(CLI::App& study, const std::shared_ptr<Action>& chosen);

}  // namespace understudy::app
