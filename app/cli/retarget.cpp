#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "app/cli/options.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

void add_import_options(CLI::App& command, ImportOptions& import, double& fps) {
  command.add_option("--fps", fps, "frames per second of the source (default: the motion's own, or 30)")
      ->check(CLI::Range(1.0, 1000.0));
  command.add_option("--up", import.up, "the source's up axis: auto, x, y, z, -x, -y, -z");
  command.add_option("--units", import.units, "the source's units: auto, m, dm, cm, mm, in");
  command.add_option("--yaw", import.yaw_deg, "turns the source about y, degrees");
  command.add_option("--floor", import.floor,
                     "height of the source's floor, metres (default: the lowest points)");
}

void add_target_options(CLI::App& command, TargetOptions& target) {
  command
      .add_option("--target", target.path,
                  "a body in T-pose: OBJ, PLY, OFF, STL, GLB, glTF, or an SMPL-format .npz")
      ->required();
  command.add_option("--betas", target.betas, "shape parameters of an SMPL-format target")->delimiter(',');
  command.add_option("--target-units", target.import.units, "the target's units: auto, m, dm, cm, mm, in");
  command.add_option("--target-up", target.import.up, "the target's up axis (default: y)");
  command.add_option("--target-yaw", target.import.yaw_deg,
                     "turns the target about y, degrees; it must face +z");
}

}  // namespace

void add_network_options(CLI::App& command, nn::NetworkOptions& networks) {
  command.add_option("--engine", networks.engine, "motion transfer: copy or paper")
      ->check(CLI::IsMember({"copy", "paper"}));
  command.add_option("--extractor", networks.extractor, "skeleton extraction: dense, or the paper's form")
      ->check(CLI::IsMember({"dense", "paper"}));
  command.add_option("--weights", networks.weights, "folder of the weights (default: beside the program)");
}

Action declare_retarget(CLI::App& command) {
  const auto job = std::make_shared<JobOptions>();
  command
      .add_option("--source", job->source.path,
                  "scans: a folder, a list or an array; or an SMPL-format body (--motion)")
      ->required();
  command.add_option("--motion", job->source.motion, "AMASS-format motion that the source body performs");
  command.add_option("--source-betas", job->source.betas, "shape parameters of the source body")
      ->delimiter(',');
  command.add_flag("--follow", job->source.follow, "the source folder is still being written");
  add_target_options(command, job->target);
  add_import_options(command, job->source.import, job->source.fps);
  add_network_options(command, job->networks);
  command.add_option("--root", job->retarget.root.mode, "path: scaled by leg length, original, in-place")
      ->transform(CLI::CheckedTransformer(std::map<std::string, RootMode>{{"scaled", RootMode::Scaled},
                                                                          {"original", RootMode::Original},
                                                                          {"in-place", RootMode::InPlace}},
                                          CLI::ignore_case));
  command.add_flag("!--no-foot-lock", job->retarget.lock_feet, "standing feet may slide");
  command.add_option("--out", job->out, "the animated target: .glb, or .npz with all figures");
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
