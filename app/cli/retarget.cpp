#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "app/cli/options.hpp"
#include "app/run/exports.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {

void add_performance_options(CLI::App& command, RetargetOptions& performance) {
  command.add_option("--root", performance.root.mode, "path: scaled by leg length, original, in-place")
      ->transform(CLI::CheckedTransformer(std::map<std::string, RootMode>{{"scaled", RootMode::Scaled},
                                                                          {"original", RootMode::Original},
                                                                          {"in-place", RootMode::InPlace}},
                                          CLI::ignore_case));
  command.add_flag("!--no-foot-lock", performance.lock_feet, "standing feet may slide");
}

void add_network_options(CLI::App& command, nn::NetworkOptions& networks) {
  command.add_option("--engine", networks.engine, "motion transfer; " + help_of(engines()))
      ->check(CLI::IsMember(names_of(engines())));
  command.add_option("--extractor", networks.extractor, "skeleton extraction; " + help_of(extractors()))
      ->check(CLI::IsMember(names_of(extractors())));
  command.add_option("--weights", networks.weights, "folder of the weights (default: beside the program)");
  command.add_option("--engine-weights", networks.engine_file,
                     "weights file of the engine in place of the folder's");
  command.add_option("--extractor-weights", networks.extractor_file,
                     "weights file of the extractor in place of the folder's");
}

Action declare_retarget(CLI::App& command) {
  const auto job = std::make_shared<JobOptions>();
  command
      .add_option("--source", job->source.path,
                  "scans: a folder of frames (" + format_names(kScanFrame) +
                      "), a list or an array; a skeletal motion: " + format_names(kMotion) +
                      "; or an SMPL-format body (--motion)")
      ->required();
  add_source_options(command, job->source);
  command
      .add_option("--target", job->target.path,
                  "a character in any upright pose, or an SMPL-format body: " + format_names(kTarget))
      ->required();
  add_target_options(command, job->target);
  add_network_options(command, job->networks);
  add_performance_options(command, job->retarget);
  command.add_option("--out", job->out, "the animated target: " + export_suffixes());
  command.add_option("--report", job->report, "report as JSON");
  command.add_option("--preview", job->preview, "contact sheet as PNG");
  command.add_option("--skeletons", job->skeletons,
                     "PNG of up to 60 frames with the extracted skeleton in each");
  return [job] {
    if (job->out.empty() && job->report.empty() && job->preview.empty() && job->skeletons.empty())
      job->out = "out.glb";
    run_job(*job);
    return 0;
  };
}

}  // namespace understudy::app
