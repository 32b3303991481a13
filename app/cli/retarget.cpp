#include <CLI/CLI.hpp>

#include "app/cli/commands.hpp"
#include "app/cli/flat_job.hpp"
#include "app/cli/job.hpp"
#include "app/cli/options.hpp"
#include "app/run/exports.hpp"
#include "app/run/keypoint_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/live/stream_format.hpp"
#include "retarget/live/stream_receiver.hpp"

namespace understudy::app {
namespace {

/// What comes in and goes out while it is made.
void add_live_options(CLI::App& command, JobOptions& job, CLI::Option* source) {
  CLI::Option* const listen = command.add_option(
      "--listen", job.source.path,
      "in place of --source: where a camera connects and sends scans, tcp://HOST:PORT (default host "
      "127.0.0.1: this machine alone; default port 9000); Ctrl+C ends it and writes what came");
  source->excludes(listen);
  command
      .add_option(
          "--stream", job.source.stream,
          "how a live stream's clouds follow each other, little endian; livescan: int32 n, n x 3 int16 "
          "mm, n x 3 uint8 RGB; ply: uint32 bytes, a PLY file of so many; float32: uint32 bytes = 12 n, "
          "n x 3 float32; auto (default): ply where a PLY begins, else livescan")
      ->check(CLI::IsMember(std::vector<std::string>(kStreamFormatNames.begin(), kStreamFormatNames.end())));
  command
      .add_option(
          "--wait", job.source.wait_s,
          "seconds without a frame after which a live stream ends (default: never), or a folder that is "
          "followed (default: 10)")
      ->check(CLI::Range(0.1, 1e6));
  command
      .add_option(
          "--send", job.send,
          "sends each pose as it is made by UDP: vmc://HOST:PORT, the VMC protocol (default "
          "127.0.0.1:39539), or osc://HOST:PORT, joints as plain OSC (default 127.0.0.1:9000); may be "
          "given several times")
      ->take_all()
      ->allow_extra_args(false);
  command.final_callback([source, listen] {
    if (source->count() + listen->count() == 0) throw CLI::RequiredError("--source or --listen");
  });
}

}  // namespace

Action declare_retarget(CLI::App& command) {
  const auto job = std::make_shared<JobOptions>();
  const auto flat = std::make_shared<FlatOptions>();
  CLI::Option* const source =
      command
          .add_option("--source", job->source.path,
                      "scans: a folder of frames (" + format_names(kScanFrame) +
                          "), a list or an array; a skeletal motion: " + format_names(kMotion) +
                          "; or an SMPL-format body (--motion); or 2D poses: a folder of JSONs, a JSON, "
                          ".npy, .npz; or -, a live stream of scans on standard input")
          ->type_name(kReadPath);
  add_live_options(command, *job, source);
  add_source_options(command, job->source);
  command
      .add_option("--target", job->target.path,
                  "a character in any upright pose, or an SMPL-format body: " + format_names(kTarget))
      ->type_name(kReadPath)
      ->required();
  add_target_options(command, job->target);
  add_method_options(command, job->how);
  add_tempo_options(command, job->tempo);
  command
      .add_option(
          "--out", job->out,
          "the animated target: " + export_suffixes() +
              "; or a folder of pose pictures (--format poses); where nothing else is asked for, out.glb")
      ->type_name(kWrittenPath);
  std::string formats;
  for (const ExportFormat& info : export_formats()) append_item(formats, info.name);
  command.add_option("--format", job->format, formats + " (default: by the suffix)");
  add_pose_options(command, job->poses);
  add_flat_options(command, *flat);
  command.add_option("--report", job->report, "report as JSON")->type_name(kWrittenPath);
  command.add_option("--preview", job->preview, "contact sheet as PNG")->type_name(kWrittenPath);
  command
      .add_option("--skeletons", job->skeletons, "PNG of up to 60 frames with the extracted skeleton in each")
      ->type_name(kWrittenPath);
  return [job, flat, &command] {
    const bool is_flat = is_flat_job(*job);
    const bool is_lifted = !is_flat && is_keypoint_source(job->source);
    check_flat_choice(command, is_flat ? FlatUse::InPicture : is_lifted ? FlatUse::Lifted : FlatUse::None);
    if (command.count("--listen") > 0) listen_address(job->source.path);
    job->source.follow = job->source.follow || is_live(job->source);
    if (job->out.empty() && job->report.empty() && job->preview.empty() && job->skeletons.empty() &&
        job->send.empty())
      job->out = is_flat ? "out.json" : "out.glb";
    if (is_lifted) job->source.smoothing = flat->smoothing;
    if (is_lifted && job->poses.canvas)
      job->source.canvas = printed("%dx%d", job->poses.canvas->width, job->poses.canvas->height);
    if (is_flat)
      run_flat_job(*job, *flat);
    else if (job->source.person == "all")
      run_jobs_of_all(*job);
    else
      run_job(*job);
    return 0;
  };
}

}  // namespace understudy::app
