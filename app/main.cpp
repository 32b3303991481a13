// The program: parses the command line, runs one subcommand, and turns every failure into one sentence.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "app/cli/commands.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/networks/networks.hpp"

namespace {

int run(int argc, char** argv) {
  understudy::app::catch_interrupts();
  CLI::App app("Understudy lets any body perform any captured motion.", "understudy");
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, understudy::app::Action>> actions;
  for (const auto& command : understudy::app::subcommands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    actions.emplace_back(sub, command.declare(*sub));
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

int main(int argc, char** argv) {
  try {
    understudy::nn::prepare_environment(/*trains=*/argc > 1 && std::string(argv[1]) == "train");
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "understudy: %s\n", error.what());
    return 1;
  }
}
