#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

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
  if (options.bad && !has_bad) log::info(options.source.path + ": all of its frames could be used");
  for (int i = 0; i < ssize(session.document.takes[0].pose_edits.fill); ++i)
    studio.run("edit.fill_learned", {"0", std::to_string(i), std::to_string(options.learned)});
  for (const FillEdit& one : session.document.takes[0].pose_edits.fill)
    if (const std::string guess = guess_of(one, ssize(performed), session.source.fps); !guess.empty())
      log::warn(options.source.path + ": " + guess);
  studio.wait_idle();
  US_CHECK(session.errors.empty(), session.errors.front().text);
}

Json report_of(const FillOptions& options, const Session& session, const std::vector<MadeFrames>& made) {
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["source"] = options.source.path;
  report["target"] = options.target.path;
  report["fps"] = session.source.fps;
  report["frames"] = session.takes[0].shown.poses.size();
  report["made_frames"] = Json::array();
  for (const MadeFrames& one : made)
    report["made_frames"].push_back({{"first", one.first}, {"last", one.last}, {"doubt_m", one.doubt_m}});
  return report;
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
  if (options.learned > 0)
    nn::load_motion_space(nn::weights_folder(network_options(options.how)));  // or throws
  const auto studio = headless_studio(options.how.weights);
  const Session& session = studio->session();
  SavedDocument asked;
  asked.document = document_of(options);
  studio->replace_document(std::move(asked), "");
  make_takes(*studio, 0, {clip_name(options.source.path)});
  fill_take(options, *studio);
  const std::vector<MadeFrames> made = made_frames(session.takes[0].shown.doubt_m);
  ExportChoice choice;
  choice.format = &format;
  auto inputs = export_inputs(session, {0}, choice);
  inputs[0].body.file.progress = [](float) { check_interrupt("during the export"); };
  const ExportCost cost = export_motion(options.out, format, inputs);
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
  command
      .add_option("--learned", options->learned,
                  "0: smooth curves between what is known; 1: what the motion space learned of people "
                  "(default: 1)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--report", options->report,
                     "which frames were made, and how doubtful they are, as JSON");
  command.add_option("--preview", options->preview, "contact sheet of the written file as PNG");
  return [options] { return fill(*options); };
}

}  // namespace understudy::app
