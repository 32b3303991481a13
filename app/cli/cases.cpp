#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/run/case_maker.hpp"

namespace understudy::app {

Action declare_cases(CLI::App& command) {
  const auto options = std::make_shared<SuiteOptions>();
  command.add_option("data", options->data, "folder of people and motions with splits.json")->required();
  command.add_option("--suite", options->suite, "what is evaluated")
      ->required()
      ->check(CLI::IsMember({"naked", "clothed", "captured", "bends", "extraction", "occluded"}));
  command.add_option("--out", options->out, "folder that the cases go into")->required();
  command.add_option("--split", options->split, "of splits.json (default: dev)");
  command.add_option("--body", options->body, "an SMPL-format body in place of the folder's own");
  command.add_option("--cases", options->cases, "only the first so many")->check(CLI::NonNegativeNumber);
  command.add_option("--frames", options->frames, "of a case (default: 90; extraction and occluded have 12)")
      ->check(CLI::Range(1, 100000));
  command.add_option("--points", options->points, "about how many a scan has (default: 8000)")
      ->check(CLI::Range(100, 10000000));
  command.add_option("--seed", options->seed, "of all that is drawn at random");
  return [options] {
    const int count = make_suite(*options, [](const std::string& name) {
      std::printf("%s\n", name.c_str());
      std::fflush(stdout);
    });
    std::printf("%d cases in %s\n", count, options->out.c_str());
    return 0;
  };
}

}  // namespace understudy::app
