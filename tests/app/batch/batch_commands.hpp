// Subcommands and lines for tests of batches.
#pragma once

#include <vector>

#include "app/batch/manifest.hpp"

namespace understudy::tests {

/// "retarget" with the options fps, no-offsets (a flag), times (a path that is read), out (one that is
/// written); "export", which takes many, with fps.
inline std::vector<app::BatchCommand> made_commands() {
  using app::BatchOption;
  app::BatchCommand retarget{"retarget", {}, false}, exporting{"export", {}, true};
  retarget.options["fps"] = exporting.options["fps"] = {};
  retarget.options["no-offsets"] = {true, BatchOption::Path::None};
  retarget.options["times"] = {false, BatchOption::Path::Read};
  retarget.options["out"] = {false, BatchOption::Path::Written};
  return {retarget, exporting};
}

/// A job of that name.
inline app::BatchJob made_job(const std::string& id) {
  app::BatchJob job;
  job.id = id;
  job.command = "retarget";
  job.sources = {"scans"}, job.targets = {"target.glb"};
  job.options["fps"] = 25;
  return job;
}

}  // namespace understudy::tests
