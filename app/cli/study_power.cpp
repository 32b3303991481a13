#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "app/cli/study_analyse.hpp"
#include "app/study/statistics.hpp"

namespace understudy::app {
namespace {

struct StudyPowerOptions {
  SimulatedStudy study;
  int simulations = 1000;
  uint64_t seed = 1;
  double level = 0.05;
};

int study_power(const StudyPowerOptions& options) {
  const double share = detection_rate(options.study, 1, options.simulations, options.seed, options.level);
  const double error = std::sqrt(share * (1 - share) / options.simulations);
  std::printf("found in %.1f %% of %d simulations (standard error %.1f %%)\n", 100 * share,
              options.simulations, 100 * error);
  return 0;
}

}  // namespace

void add_study_power(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<StudyPowerOptions>();
  SimulatedStudy& simulated = options->study;
  CLI::App& command = *study.add_subcommand(
      "power", "how often a design would find an effect of its first factor, by simulated Likert answers");
  command.add_option("--participants", simulated.participants, "how many are asked (default: 30)")
      ->check(CLI::Range(2, 100000));
  command.add_option("--levels", simulated.levels, "how many levels each factor has (default: 3)")
      ->check(CLI::Range(2, 1000));
  command.add_option("--repetitions", simulated.repetitions, "answers to each combination (default: 1)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--shifts", simulated.shifts,
                     "what each level of the first factor adds, points of the scale (default: no effect)");
  command
      .add_option("--participant-sd", simulated.participant_sd,
                  "standard deviation of participants' means, points (default: 0.8)")
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option("--habit-sd", simulated.habit_sd,
                  "of what participants add to a combination, points (default: 0.4)")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--noise-sd", simulated.noise_sd, "of single answers, points (default: 1.2)")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--scale", simulated.high, "points of the scale (default: 7)")
      ->check(CLI::Range(2, 100));
  command.add_option("--simulations", options->simulations, "how many (default: 1000)")
      ->check(CLI::Range(1, 1000000));
  command.add_option("--level", options->level, "p below which an effect counts as found (default: 0.05)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--seed", options->seed, "seed of the random numbers");
  command.callback([options, chosen] { *chosen = [options] { return study_power(*options); }; });
}

}  // namespace understudy::app
