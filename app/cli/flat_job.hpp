// One job of 2D poses: a track onto a person in a picture, into files.
#pragma once

#include "app/cli/job.hpp"
#include "app/run/flat_performance.hpp"

namespace understudy::app {

/// Options of 2D poses that retarget has beside those of JobOptions.
void add_flat_options(CLI::App& command, FlatOptions& flat);

/// Whether the job's target is somebody in a picture (2D poses, or proportions), who performs 2D poses alone:
/// other targets perform in space what is lifted.
bool is_flat_job(const JobOptions& job);
/// What a job has to do with 2D poses.
enum class FlatUse { InPicture, Lifted, None };
/// Throws Error naming an option that was given and would do nothing in such a job.
void check_flat_choice(const CLI::App& command, FlatUse use);

/// Does it. Paths, the person, --fps and --weights are those of `job`. Throws Error; also where the job wants
/// what 2D poses do not have.
void run_flat_job(const JobOptions& job, FlatOptions flat);

}  // namespace understudy::app
