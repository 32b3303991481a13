// The subcommands: one file and one row of the table each.
#pragma once

#include <functional>
#include <vector>

namespace CLI {
class App;
}

namespace understudy::app {

/// Does the work after the command line is parsed; gives the exit code, throws Error.
using Action = std::function<int()>;

struct Subcommand {
  const char* name;
  const char* help;
  Action (*declare)(CLI::App& command);  ///< adds its options and gives the action that reads them
};

const std::vector<Subcommand>& subcommands();

}  // namespace understudy::app
