// `study new` and `study trials`.
#pragma once

#include <memory>

#include "app/cli/commands.hpp"

namespace understudy::app {

/// Adds the subcommands to `study`; the one that is called puts its action into `chosen`.
void add_study_new(CLI::App& study, const std::shared_ptr<Action>& chosen);
void add_study_trials(CLI::App& study, const std::shared_ptr<Action>& chosen);

}  // namespace understudy::app
