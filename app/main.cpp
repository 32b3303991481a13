// The program: parses the command line, runs one subcommand, and turns every failure into one sentence.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "app/cli/commands.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {
namespace {

struct Subcommand {
  const char* name;
  const char* help;
  Action (*declare)(CLI::App& command);
};

constexpr Subcommand kSubcommands[] = {
    {"studio", "opens the window", declare_studio},
    {"play", "plays a script of the studio without a window", declare_play},
    {"retarget", "lets a target perform what a source does", declare_retarget},
    {"export", "a character performs motions, as an animated GLB or glTF", declare_export},
    {"batch", "does a list of such jobs, in any number of processes, and goes on where it was stopped",
     declare_batch},
    {"discover", "finds the bones of anything that moves in its scans", declare_discover},
    {"generate", "makes more of what a rigged character does in its clip", declare_generate},
    {"fill", "makes the frames of a motion that were not captured, or not well", declare_fill},
    {"style", "lets somebody move in another style, on their own bones", declare_style},
    {"sheet", "shows several performances below each other, a moment a column", declare_sheet},
    {"blend", "makes what lies between two to four motions", declare_blend},
    {"map", "shows the steps of many motions by their likeness, and finds those like a given one",
     declare_map},
    {"cases", "makes suites of test cases from people and motions", declare_cases},
    {"eval", "evaluates the method on a folder of cases", declare_eval},
    {"measure", "metrics of a source that need no ground truth", declare_measure},
    {"report", "compares ways to do the job: a page of tables and plots", declare_report},
    {"steps", "how well steps are coded as points of a motion space", declare_steps},
    {"train", "trains a network", declare_train},
    {"sample", "writes the bundled samples as files", declare_sample},
    {"doctor", "reports BLAS, threads, OpenGL and weights", declare_doctor},
    {"bench", "measures time, memory and work of a frame", declare_bench},
    {"study", "perceptual studies: designs, trials, statistics", declare_study},
    {"demo", "the bundled scan onto the bundled targets", declare_demo},
    {"import-worker", "reads a file in a process of its own", declare_import_worker},
};

int run(int argc, char** argv) {
  catch_interrupts();
  CLI::App app("Understudy lets any body perform any captured motion.", "understudy");
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, Action>> actions;
  for (const Subcommand& command : kSubcommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    actions.emplace_back(sub, command.declare(*sub));
  }
  if (argc < 2) {
    std::fputs(
        "understudy: name a subcommand: \"understudy studio\" opens the window, \"understudy --help\" "
        "lists all\n",
        stderr);
    return 2;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {  // --help too
    return app.exit(error) == 0 ? 0 : 2;
  }
  for (const auto& [sub, action] : actions)
    if (sub->parsed()) return action();
  return 2;
}

}  // namespace
}  // namespace understudy::app

int main(int argc, char** argv) {
  try {
    const std::string command = argc > 1 ? argv[1] : "";
    const bool is_many =
        command == "train" || command == "batch";  // threads or processes, each computes alone
    understudy::nn::prepare_environment(/*trains=*/is_many);
    return understudy::app::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "understudy: %s\n", error.what());
    return 1;
  }
}
