// One retargeting job: frames from a source onto a target, online, into files.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.hpp"
#include "app/run/retargeted_source.hpp"

namespace understudy::app {

struct JobOptions {
  SourceOptions source;
  TargetOptions target;
  MethodOptions how;
  TempoChoice tempo;
  std::string out;        ///< empty: none
  std::string format;     ///< of it; empty: by its suffix
  PoseChoice poses;       ///< of pose pictures
  std::string report;     ///< .json; empty: none
  std::string preview;    ///< .png; empty: none
  std::string skeletons;  ///< .png of up to 60 frames with the extracted skeleton in each; empty: none
  std::vector<std::string> send;  ///< addresses of engines, see PoseSender
  bool progress_lines = false;    ///< new lines of progress even on a terminal: another job writes there too
};

/// Does the job and reports progress. Files appear whole at the end, or not at all. Throws Error.
void run_job(const JobOptions& options);
/// A job for each person in the source, into files of their own: out-1.glb, out-2.glb, ... for out.glb.
/// Throws Error.
void run_jobs_of_all(const JobOptions& options);

}  // namespace understudy::app
