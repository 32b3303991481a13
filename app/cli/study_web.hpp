// `study web`.
#pragma once

#include <memory>

#include "app/cli/commands.hpp"

namespace understudy::app {

/// Adds the subcommand to `study`; when it is chosen, `chosen` becomes its action.
void add_study_web(CLI::App& study, const std::shared_ptr<Action>& chosen);

}  // namespace understudy::app
