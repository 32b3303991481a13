// study stimuli: the clips of a study.
#pragma once

#include <memory>

#include "app/cli/commands.hpp"

namespace understudy::app {

void add_study_stimuli(CLI::App& study, const std::shared_ptr<Action>& chosen);

}  // namespace understudy::app
