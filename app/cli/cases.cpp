#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/run/case_maker.hpp"
#include "app/run/creature_suites.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {

Action declare_cases(CLI::App& command) {
  const auto options = std::make_shared<SuiteOptions>();
  command.add_option("data", options->data,
                     "folder of people and motions with splits.json; creatures need none");
  command.add_option("--suite", options->suite, "the suite to make")
      ->required()
      ->check(
          CLI::IsMember({"naked",           "clothed",         "captured", "hands",     "bends",
                         "extraction",      "occluded",        "partial",  "sensors",   "scenes",
                         "inbetween",       "predict",         "sparse",   "creatures", "creatures-captured",
                         "creatures-pairs", "marionette-gaps", "style",    "pose2d",    "pose2d-odd",
                         "pose2d-noisy",    "pose2d-seen",     "lifting"}));
  command.add_option("--out", options->out, "folder that the cases go into")->required();
  command.add_option("--split", options->split,
                     "split of splits.json, of creatures dev or train (default: dev)");
  command.add_option("--body", options->body, "an SMPL-format body in place of the folder's own");
  command.add_option("--cases", options->cases, "at most this many cases")->check(CLI::NonNegativeNumber);
  const CLI::Option* frames =
      command
          .add_option(
              "--frames", options->frames,
              "frames per case, at most (default: 90, of creatures 60; fewer where a suite is shorter)")
          ->check(CLI::Range(1, 100000));
  command
      .add_option("--points", options->points,
                  "points per scan, roughly (default: 8000); 0, of inbetween, predict and sparse: no scans")
      ->check(CLI::Range(0, 10000000));
  command.add_option("--gap", options->gap, "frames that are not known (inbetween; predict, default: 15)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--known", options->known, "frames of 100 that are known, evenly (sparse)")
      ->check(CLI::Range(2, 100));
  command.add_option("--markers", options->markers, "markers on the body in known frames (sparse)")
      ->check(CLI::IsMember({0, 16}));
  command.add_flag("--walks", options->walks,
                   "walks and runs only, a window every 3 frames (inbetween, predict, sparse)");
  command.add_option("--from", options->from, "folder in data of clips that are to be styled (style)");
  command.add_option("--to", options->to, "folder in data of clips in the manner that is wanted (style)");
  command.add_option("--seed", options->seed, "seed of the random numbers");
  return [options, frames] {
    const bool creatures = is_creature_suite(options->suite);
    US_CHECK(creatures || !options->data.empty(), "the suite ", options->suite,
             " needs a folder of people and motions");
    if (creatures && frames->count() == 0) options->frames = kCreatureFrames;
    const int count = make_suite(*options, [](const std::string& name) {
      std::printf("%s\n", name.c_str());
      std::fflush(stdout);
    });
    std::printf("%d cases in %s\n", count, options->out.c_str());
    return 0;
  };
}

}  // namespace understudy::app
