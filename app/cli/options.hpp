// Options that several subcommands take.
#pragma once

#include "retarget/nn/networks.hpp"

namespace CLI {
class App;
}

namespace understudy::app {

/// --engine, --extractor, --weights.
void add_network_options(CLI::App& command, nn::NetworkOptions& networks);

}  // namespace understudy::app
