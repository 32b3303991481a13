// `study analyse` and `study power`: the statistics of a study, after and before it.
#pragma once

#include <memory>

#include "app/cli/commands.hpp"

namespace understudy::app {

/// Each adds its subcommand to `study`; when it is chosen, `chosen` becomes its action.
void add_study_analyse(CLI::App& study, const std::shared_ptr<Action>& chosen);
void add_study_power(CLI::App& study, const std::shared_ptr<Action>& chosen);

}  // namespace understudy::app
