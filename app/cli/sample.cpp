#include <CLI/CLI.hpp>

#include "app/cli/commands.hpp"
#include "app/run/samples.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {

Action declare_sample(CLI::App& command) {
  const auto folder = std::make_shared<std::string>();
  command.add_option("folder", *folder, "where the samples go; created if missing")->required();
  return [folder] {
    write_samples(*folder);
    log::info("wrote the samples to " + *folder);
    return 0;
  };
}

}  // namespace understudy::app
