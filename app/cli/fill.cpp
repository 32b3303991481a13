#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <optional>

#include "app/cli/commands.hpp"
#include "app/cli/file_preview.hpp"
#include "app/cli/headless.hpp"
#include "app/cli/options.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

struct FillOptions {
  SourceOptions source;
  TargetOptions target;
  MethodOptions how;
  std::string out, report, preview;
  std::vector<std::string> ranges;
  bool bad = false;
  float learned = 1;
  int variation = 0;
  std::optional<double> until;  // seconds from the first frame
  bool loop = false;
};

/// "40:55".
FillEdit range_of(const std::string& text) {
  const size_t colon = text.find(':');
  double first = 0, last = 0;
  const auto is_frame = [](double number) {
    return number >= 0 && number < 1e9 && number == std::floor(number);
  };
  US_CHECK(colon != std::string::npos && parse_number(text.substr(0, colon), first) &&
               parse_number(text.substr(colon + 1), last) && is_frame(first) && is_frame(last),
           "--range ", text, ": is not FIRST:LAST, two numbers of frames");
  return {static_cast<int>(first), static_cast<int>(last)};
}

Document document_of(const FillOptions& options) {
  Document document;
  document.source = options.source;
  Take& take = document.takes.emplace_back();
  take.name = clip_name(options.target.path);
  take.target = options.target;
  take.method = options.how.method;
  take.target_edits.rest_pose = options.how.rest_pose;
  return document;
}

void check_done(Studio& studio) {
  studio.wait_idle();
  US_CHECK(studio.session().errors.empty(), studio.session().errors.front().text);
}

void go_on_until(const FillOptions& options, Studio& studio) {
  const Session& session = studio.session();
  const double there = static_cast<double>(session.takes[0].performed.size()) / session.source.fps;
  US_CHECK(*options.until > there, "--until ", *options.until, ": ", options.source.path, " is ", there,
           " seconds long already");
  studio.run("edit.go_on", {"0", std::to_string(*options.until - there)});
  studio.run("edit.go_on_learned", {"0", std::to_string(options.learned)});
  studio.run("edit.go_on_variation", {"0", std::to_string(options.variation)});
  const auto added = frames_added(*session.document.takes[0].pose_edits.go_on, session.source.fps);
  const int first = ssize(session.takes[0].performed), last = first + added - 1;
  log::warn(options.source.path + ": " + guess_of({first, last}, last + 1, session.source.fps));
}

/// Between two like moments of what was filled.
void make_loop(const FillOptions& options, Studio& studio) {
  check_done(studio);
  studio.run("edit.loop", {"0"});
  studio.run("edit.loop_learned", {"0", std::to_string(options.learned)});
}

/// Fills what is asked for, and waits for it.
void fill_take(const FillOptions& options, Studio& studio) {
  const Session& session = studio.session();
  for (const std::string& text : options.ranges) {
    const FillEdit range = range_of(text);
    studio.run("edit.fill", {"0", std::to_string(range.first), std::to_string(range.last)});
  }
  bool has_bad = false;
  const auto& performed = session.takes[0].performed;
  for (const KeptFrame& frame : performed) has_bad = has_bad || frame.flagged;
  if (options.bad && has_bad) studio.run("edit.fill", {"0", "bad"});
  if (options.bad && !has_bad && !options.until && !options.loop)
    log::info(options.source.path + ": all of its frames could be used");
  for (int i = 0; i < ssize(session.document.takes[0].pose_edits.fill); ++i) {
    studio.run("edit.fill_learned", {"0", std::to_string(i), std::to_string(options.learned)});
    studio.run("edit.fill_variation", {"0", std::to_string(i), std::to_string(options.variation)});
  }
  for (const FillEdit& one : session.document.takes[0].pose_edits.fill)
    if (const std::string guess = guess_of(one, ssize(performed), session.source.fps); !guess.empty())
      log::warn(options.source.path + ": " + guess);
  if (options.until) go_on_until(options, studio);
  if (options.loop) make_loop(options, studio);
  check_done(studio);
}

/// What is made of the frames: those that play, from 0 on.
std::vector<MadeFrames> made_of(const Session& session) {
  const Motion& shown = session.takes[0].shown;
  std::vector<float> doubt_m;
  for (const MomentBetween& moment : moments_of(session, 0))
    doubt_m.push_back(moment.before < ssize(shown.doubt_m) ? shown.doubt_m[static_cast<size_t>(moment.before)]
                                                           : 0);
  return made_frames(doubt_m);
}

Json loop_of(const Session& session, const LoopEdit& loop) {
  const LoopTravel travel = travel_of(loop, session.takes[0].shown);
  return {
      {"first", loop.first}, {"last", loop.last}, {"travel_m", travel.metres}, {"turn_deg", travel.turn_deg}};
}

Json report_of(const FillOptions& options, const Session& session, const std::vector<MadeFrames>& made) {
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["source"] = options.source.path;
  report["target"] = options.target.path;
  report["fps"] = session.source.fps;
  report["frames"] = moments_of(session, 0).size();
  report["learned"] = options.learned;
  report["variation"] = options.variation;
  if (const auto& loop = session.document.takes[0].pose_edits.loop) report["loop"] = loop_of(session, *loop);
  report["made_frames"] = to_json(made);
  return report;
}

/// How much is learned: nothing where the motion space cannot be had.
float usable(const FillOptions& options) {
  if (options.learned <= 0) return 0;
  const std::string problem =
      failure_of([&] { nn::load_motion_space(nn::weights_folder(network_options(options.how))); });
  if (!problem.empty()) log::warn(problem + ": what is made follows smooth curves");
  return problem.empty() ? options.learned : 0;
}

int fill(FillOptions options) {
  const ExportFormat& format = export_format("", options.out);
  check_not_read(options.out, {options.source.path, options.source.motion, options.target.path});
  check_export(options.out, format);
  US_CHECK(options.preview.empty() || format.is_character, options.preview,
           ": --preview needs a GLB or glTF file");
  for (const std::string& path : {options.report, options.preview}) check_writable(path);
  options.bad = options.bad || options.ranges.empty();
  for (const std::string& text : options.ranges) range_of(text);
  options.learned = usable(options);
  const auto studio = headless_studio(options.how.weights);
  const Session& session = studio->session();
  SavedDocument asked;
  asked.document = document_of(options);
  studio->replace_document(std::move(asked), "");
  make_takes(*studio, 0, {clip_name(options.source.path)});
  fill_take(options, *studio);
  const std::vector<MadeFrames> made = made_of(session);
  ExportChoice choice;
  choice.format = &format;
  auto inputs = export_inputs(session, {0}, choice);
  inputs[0].body.file.progress = [](float) { check_interrupt("during the export"); };
  const ExportCost cost = export_motion(options.out, format, inputs);
  if (const auto& loop = session.document.takes[0].pose_edits.loop) {
    const LoopTravel travel = travel_of(*loop, session.takes[0].shown);
    std::printf("frames %d to %d of the source play in a loop, %.2f m and %.0f degrees farther each round\n",
                loop->first, loop->last, static_cast<double>(travel.metres),
                static_cast<double>(travel.turn_deg));
  }
  for (const MadeFrames& one : made)
    std::printf("frames %d to %d were made, expected to be off by up to %.1f cm\n", one.first, one.last,
                static_cast<double>(100 * one.doubt_m));
  std::printf("%s %lld bytes, %zu frames\n", options.out.c_str(), static_cast<long long>(cost.bytes),
              inputs[0].clips[0].poses.size());
  if (!options.report.empty()) write_json(options.report, report_of(options, session, made));
  if (!options.preview.empty())
    write_file_preview(options.preview, options.out, inputs, clip_name(options.target.path));
  return 0;
}

}  // namespace

Action declare_fill(CLI::App& command) {
  const auto options = std::make_shared<FillOptions>();
  command
      .add_option("--source", options->source.path, "scans or a skeletal motion, as `retarget` takes them")
      ->required();
  add_source_options(command, options->source);
  command
      .add_option("--target", options->target.path,
                  "a character in any upright pose, or an SMPL-format body: " + format_names(kTarget))
      ->required();
  add_target_options(command, options->target);
  add_method_options(command, options->how);
  command.add_option("--out", options->out, "the animated target: " + export_suffixes())->required();
  command.add_option("--range", options->ranges,
                     "frames FIRST:LAST that are made from those around them; may be given several times");
  command.add_flag("--bad", options->bad,
                   "makes all frames that could not be used, missing ones too (default without --range)");
  const auto until = command.add_option(
      "--until", options->until,
      "goes on beyond the last frame until so many seconds from the first: a prediction, and said to be");
  command
      .add_flag("--loop", options->loop,
                "keeps what lies between the two most alike moments, and closes the seam between them")
      ->excludes(until);
  command
      .add_option("--learned", options->learned,
                  "0: smooth curves between what is known; 1: what the motion space learned of people "
                  "(default: 1)")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option(
          "--variation", options->variation,
          "which of the motion space's answers, of frames that are made and of --until: 0 the best, 1 "
          "to 3 others (default: 0)")
      ->check(CLI::Range(kVariationNumbers.low, kVariationNumbers.high));
  command.add_option("--report", options->report,
                     "which frames were made, and how doubtful they are, as JSON");
  command.add_option("--preview", options->preview, "contact sheet of the written file as PNG");
  return [options] { return fill(*options); };
}

}  // namespace understudy::app
