#include "app/cli/job.hpp"

#include <cstdio>
#include <filesystem>

#include "app/cli/preview.hpp"
#include "app/cli/progress.hpp"
#include "app/run/doubt_tally.hpp"
#include "app/run/evaluator.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/live_figures.hpp"
#include "app/run/pose_output.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/kernels/kernels.hpp"

namespace understudy::app {
namespace {

/// All that a job keeps between frames.
struct Running {
  std::unique_ptr<Source> source;
  std::shared_ptr<const PreparedCharacter> character;
  std::unique_ptr<Retargeter> retargeter;
  std::unique_ptr<RetargetedSource> retargeted;
  std::unique_ptr<MotionOutput> output;  // null: no animation wanted
  std::optional<PoseOutput> sent;        // none: nothing is sent
  std::optional<TempoStream> tempo;      // of the output
  bool has_style = false;                // or a tempo of its own
  std::vector<Pose> shown;               // at that tempo, where a report tells how it is performed
  std::optional<PreviewMoments> moments, skeletons;
  std::optional<Evaluator> evaluator;
  Latency latency;
  DoubtTally doubt;
  LiveFigures live;
  log::Tally repeats;          // of the last pose
  std::vector<float> doubt_m;  // of each frame that was made, 0 where it was captured
};

/// Moments and columns of a sheet that shows the extraction alone.
constexpr int kSkeletonMoments = 60, kSkeletonColumns = 12;

render::SheetMoment source_moment(const RetargetedFrame& frame, double fps) {
  render::SheetMoment moment;
  moment.frame = frame.index;
  moment.seconds = static_cast<double>(frame.index) / fps;
  moment.source = frame.scan.mesh;
  moment.skeleton = render::skeleton_view(source_joints(frame.result));
  return moment;
}

render::SheetMoment moment_of(const RetargetedFrame& frame, double fps, const Mesh& rest) {
  render::SheetMoment moment = source_moment(frame, fps);
  moment.target = Mesh{frame.result.vertices, rest.faces, rest.colors};
  return moment;
}

/// One line for each frame as it is finished, for programs that follow along.
void tell_live(const RetargetedFrame& frame, LiveFigures& figures) {
  const double ms = figures.add(frame.scan);
  const Vec3& root = frame.result.pose.root;
  std::printf("frame %lld root %.4f %.4f %.4f %s", static_cast<long long>(frame.scan.number), root.x(),
              root.y(), root.z(), frame.result.flagged ? "flagged" : "good");
  if (frame.scan.live)
    std::printf(" latency_ms %.2f dropped %lld", ms, static_cast<long long>(frame.scan.live->dropped));
  std::puts("");
  std::fflush(stdout);
}

void write(Running& job, const std::vector<PerformedFrame>& frames,
           const std::optional<LiveMoment>& live = {}) {
  for (const PerformedFrame& frame : frames) {
    if (job.sent) job.sent->push(frame, live);
    if (job.has_style && job.evaluator) job.shown.push_back(frame.pose);
    if (job.output)
      job.output->push({frame.pose, source_joints(frame), &frame.vertices, frame.observed.doubt_m});
  }
}

void take_frame(Running& job, const RetargetedFrame& frame, bool live) {
  const PerformedFrame& result = frame.result;
  const double fps = job.source->fps();
  job.latency.add(frame.times);
  job.doubt.add(result);
  if (result.flagged)
    job.repeats.warn("frame " + std::to_string(frame.scan.number) +
                     " repeats the last pose: " + result.reason);
  job.doubt_m.push_back(result.observed.doubt_m);
  write(job, job.tempo->push(result), frame.scan.live);
  if (live) tell_live(frame, job.live);
  if (job.moments && job.moments->wanted(frame.index))
    job.moments->add(frame.index, moment_of(frame, fps, job.character->target.mesh));
  if (job.skeletons && job.skeletons->wanted(frame.index))
    job.skeletons->add(frame.index, source_moment(frame, fps));
  if (job.evaluator)
    job.evaluator->push({&result.vertices, &result.joints, &result.pose.local, &source_joints(result),
                         nullptr, frame.scan.usable ? &frame.scan.mesh : nullptr, nullptr, result.limbs});
}

Json report_of(const JobOptions& options, const Running& job) {
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["engine"] = options.how.method.engine;
  if (options.how.method.style.any()) report["style"] = style_json(options.how.method.style);
  if (options.tempo.any()) report["length"] = job.tempo->length();
  report["source"] = options.source.path;
  report["target"] = options.target.path;
  report["fps"] = job.source->fps();
  report["frames"] = job.retargeted->frames();
  report["flagged"] = job.retargeted->flagged();
  report["doubt"] = job.doubt.json();
  if (const std::vector<MadeFrames> made = made_frames(job.doubt_m); !made.empty())
    report["made_frames"] = to_json(made);
  Metrics metrics = job.evaluator->metrics();
  for (const auto& figure :
       style_figures(job.shown, job.character->target.joints, job.source->fps(), job.evaluator->has_legs()))
    metrics.push_back(figure);
  report["metrics"] = to_json(metrics);
  report["ms"] = to_json(job.latency, 0.5);
  report["ms_p95"] = to_json(job.latency, 0.95);
  if (job.live.any())
    report["live"] = {{"dropped", job.live.dropped()},
                      {"capture_to_wire_ms", job.live.ms().quantile(0.5)},
                      {"capture_to_wire_ms_p95", job.live.ms().quantile(0.95)},
                      {"capture_to_wire_ms_most", job.live.most_ms()}};
  return report;
}

bool makes_files(const JobOptions& options) {
  return !(options.out.empty() && options.report.empty() && options.preview.empty() &&
           options.skeletons.empty());
}

Running start(const JobOptions& options) {
  Running job;
  Networks networks = nn::load_networks(network_options(options.how));
  job.character = open_target(options.target, networks);
  networks = networks_for(std::move(networks), *job.character, on_their_rig(options.target, *job.character));
  job.source = open_source(options.source);
  log::info(std::string("inference: one thread, ") + nn::kernels().name + " kernels");
  RetargetOptions how = retarget_options(options.how);
  how.vertices = makes_files(options);  // an engine has a surface of its own
  job.retargeter = std::make_unique<Retargeter>(std::move(networks), how);
  job.retargeter->set_target(job.character->target);
  job.retargeted = std::make_unique<RetargetedSource>(*job.source, *job.retargeter, options.source,
                                                      source_tools(options.how));
  job.has_style = options.how.method.style.any() || options.tempo.any();
  job.tempo.emplace(options.tempo, job.character->target.joints, job.source->fps());
  if (!options.send.empty())
    job.sent.emplace(PoseOutputOptions{options.send, job.source->fps(), !options.source.follow},
                     job.character->target);
  if (!options.preview.empty()) job.moments.emplace(job.source->count());
  if (!options.skeletons.empty()) job.skeletons.emplace(job.source->count(), kSkeletonMoments);
  if (!options.report.empty()) job.evaluator.emplace(job.source->fps(), nullptr, &job.character->target.mesh);
  if (!options.out.empty()) {
    const ExportFormat& format = export_format(options.format, options.out);
    ExportBody body{job.character, job.retargeter->performer().deformer(), {}};
    body.file.rights = style_rights(options.how.method.style);
    body.poses = options.poses;
    if (format.is_pictures && !is_live(options.source))
      body.file.progress = [](float) { check_interrupt("during the export"); };
    body.file.their_rig = format.is_character && on_their_rig(options.target, *job.character);
    job.output = open_export(options.out, format, body, file_name(options.source.path), job.source->fps());
  }
  return job;
}

void finish(const JobOptions& options, Running& job) {
  job.repeats.finish();
  write(job, job.tempo->finish());
  if (job.output) {
    job.output->set_source_to_scan(job.source->to_file());
    log::info(options.out + ": " + sentence(job.output->finish()));
  }
  if (job.evaluator) write_json(options.report, report_of(options, job));
  const std::string title =
      file_name(options.source.path) + " performed by " + file_name(options.target.path);
  if (job.moments) write_preview(options.preview, job.moments->take(), title);
  if (job.skeletons)
    write_preview(options.skeletons, job.skeletons->take(), file_name(options.source.path), kSkeletonColumns);
  if (job.live.any()) log::info(options.source.path + ": " + job.live.sentence());
  std::fprintf(stderr, "%s", job.latency.table().c_str());
  for (const std::string& path : {options.out, options.report, options.preview, options.skeletons})
    if (!path.empty()) log::info("wrote " + path);
}

/// "out.glb" is "out-2.glb" for person 2.
std::string path_of_person(const std::string& path, int id) {
  const std::filesystem::path whole(path);
  const std::string name = whole.stem().string() + "-" + std::to_string(id) + whole.extension().string();
  return (whole.parent_path() / name).string();
}

}  // namespace

void run_job(const JobOptions& options) {
  check(options.tempo);
  check_not_read(options.out, {options.source.path, options.source.motion, options.source.times,
                               options.source.markers, options.target.path});
  if (!options.out.empty()) {
    const ExportFormat& format = export_format(options.format, options.out);
    check_pose_choice(options.out, format, options.poses);
    check_export(options.out, format);
  }
  for (const std::string& path : {options.report, options.preview, options.skeletons}) check_writable(path);
  const bool live = is_live(options.source);  // whose end an interrupt is: what came is kept
  for (const std::string& address : options.send) send_address(address);
  Running job = start(options);
  Progress progress(file_name(options.source.path) + " -> " + file_name(options.target.path),
                    job.source->count().value_or(0), options.progress_lines);
  while (const auto frame = job.retargeted->next()) {
    take_frame(job, *frame, options.source.follow);
    progress.step(frame->index + 1);
    if (!live) check_interrupt("after frame " + std::to_string(frame->scan.number));
  }
  progress.finish();
  if (!live) check_interrupt("after " + std::to_string(job.retargeted->frames()) + " frames");
  job.retargeted->check_used();
  if (job.retargeted->frames() == 1)
    log::warn(options.source.path + ": holds only one frame: the result is a pose, not a motion");
  finish(options, job);
}

void run_jobs_of_all(const JobOptions& options) {
  check_source_options(options.source);  // a live stream cannot be gone through first
  NetworkParts seeing;
  seeing.extractor = true;
  const Networks networks = nn::load_networks(network_options(options.how), seeing);
  for (const int id : all_people(options.source, networks.extractor)) {
    JobOptions one = options;
    one.source.person = std::to_string(id);
    for (std::string* path : {&one.out, &one.report, &one.preview, &one.skeletons})
      if (!path->empty()) *path = path_of_person(*path, id);
    run_job(one);
  }
}

}  // namespace understudy::app
