#include "app/cli/commands.hpp"

namespace understudy::app {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {};
  return table;
}

}  // namespace understudy::app
