#include <CLI/CLI.hpp>

#include "app/cli/commands.hpp"
#include "app/cli/study_analyse.hpp"
#include "app/cli/study_design.hpp"
#include "app/cli/study_run.hpp"
#include "app/cli/study_stimuli.hpp"
#include "app/cli/study_web.hpp"

namespace understudy::app {

Action declare_study(CLI::App& command) {
  const auto chosen = std::make_shared<Action>();
  command.require_subcommand(1);
  add_study_new(command, chosen);
  add_study_trials(command, chosen);
  add_study_stimuli(command, chosen);
  add_study_run(command, chosen);
  add_study_web(command, chosen);
  add_study_analyse(command, chosen);
  add_study_power(command, chosen);
  return [chosen] { return (*chosen)(); };
}

}  // namespace understudy::app
