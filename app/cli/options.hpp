// Options that several subcommands take.
#pragma once

#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace CLI {
class App;
}

namespace understudy::app {

/// All that may be said of a source but --source itself.
void add_source_options(CLI::App& command, SourceOptions& source);

/// All that may be said of a target but --target itself.
void add_target_options(CLI::App& command, TargetOptions& target);

/// How the motion is performed: --root, --no-foot-lock.
void add_performance_options(CLI::App& command, RetargetOptions& performance);

/// --engine, --extractor, --weights, --engine-weights, --extractor-weights.
void add_network_options(CLI::App& command, nn::NetworkOptions& networks);

}  // namespace understudy::app
