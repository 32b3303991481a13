#include "app/cli/flat_job.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "app/run/exports.hpp"
#include "app/run/keypoint_source.hpp"
#include "app/run/pose_pictures.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {
namespace {

void write_flat_report(const std::string& path, const FlatPerformance& made, const MethodOptions& how) {
  Json json = report_header(nn::weights_folder(network_options(how)));
  json["engine"] = flat_engine(how);
  json["source"] = {{"path", made.source.path},
                    {"format", made.source.format},
                    {"layout", made.source.layout},
                    {"frames", made.source.frames.size()},
                    {"people", made.source.tracks.size()},
                    {"fps", made.source.fps}};
  json["told"] = made.told;
  json["flagged"] = made.flagged;
  json["source_lengths"] = to_json(made.source_lengths);
  json["target_lengths"] = to_json(made.target_lengths);
  Json problems = Json::array();
  for (const KeypointFrame& frame : made.result.frames)
    if (!frame.problem.empty()) problems.push_back({{"frame", frame.number}, {"problem", frame.problem}});
  json["problems"] = problems;
  write_json(path, json);
}

/// One line for each frame as it is finished, for programs that follow along; its pictures are there by then.
void tell_live(const KeypointFrame& frame) {
  std::printf("frame %lld %s\n", static_cast<long long>(frame.number),
              frame.problem.empty() ? "good" : frame.problem.c_str());
  std::fflush(stdout);
}

/// Of a folder that is still being written; a folder of pictures gets them as they come.
FlatPerformance follow_and_write(const JobOptions& job, const FlatOptions& flat, const FlatTools& tools) {
  std::optional<ComingPictures> coming;
  if (!job.out.empty() && file_suffix(job.out).empty()) coming.emplace(job.out, job.poses);
  FlatPerformance made = follow_flat(flat, tools, [&](const KeypointReading& one) {
    if (coming) coming->push(one);
    tell_live(one.frames[0]);
  });
  if (coming) coming->finish(made.result);
  if (!coming && !job.out.empty()) write_flat(job.out, made.result, job.poses);
  return made;
}

FlatPerformance perform_and_write(const JobOptions& job, const FlatOptions& flat, const FlatTools& tools) {
  FlatPerformance made = perform_flat(flat, tools);
  if (!job.out.empty()) write_flat(job.out, made.result, job.poses);
  return made;
}

}  // namespace

void add_flat_options(CLI::App& command, FlatOptions& flat) {
  command.add_option_function<std::string>(
      "--target-canvas", [&flat](const std::string& text) { flat.target.canvas = parse_canvas(text); },
      "of a target that is 2D poses: its picture's size (default: as the file or a picture beside it tells)");
  command.add_option("--target-person", flat.target.person,
                     "who of several people in a target that is 2D poses (default: who is seen longest)");
  command
      .add_option_function<std::string>(
          "--place",
          [&flat](const std::string& word) {
            flat.place = word == kFlatPlaceNames[1] ? FlatPlace::Source : FlatPlace::Reference;
          },
          "of 2D poses: reference, starts where the target stands in its picture (default), or source")
      ->check(CLI::IsMember({kFlatPlaceNames[0], kFlatPlaceNames[1]}));
  command.add_flag_callback(
      "--let-go", [&flat] { flat.touches = false; }, "of 2D poses: hands need not touch what they touched");
  command
      .add_option("--smoothing", flat.smoothing,
                  "of 2D poses: 0, points stay where they were seen; 1, as tuned (default); 2, half the "
                  "jitter, later")
      ->check(CLI::Range(0.0f, 4.0f));
  command.add_flag_callback(
      "--no-growth", [&flat] { flat.growth = false; },
      "of 2D poses: the result stays of one size where the source comes nearer or goes away");
  command.add_flag_callback(
      "--no-look-ahead", [&flat] { flat.ahead = false; },
      "of 2D poses: the source's proportions are learned as its frames come");
}

bool is_flat_job(const JobOptions& job) {
  // The target tells: a folder that is still being written may have no pose in it yet, and where the source
  // is not what it should be the user is told that.
  return file_suffix(job.target.path) == ".json" || is_proportions_file(job.target.path) ||
         looks_like_keypoints(job.target.path);
}

void check_flat_choice(const CLI::App& command, FlatUse use) {
  using Names = std::set<std::string>;
  static const Names in_picture = {"target-canvas", "target-person", "place",
                                   "let-go",        "no-growth",     "no-look-ahead"};
  static const Names also = {"smoothing", "source",         "target",  "person",    "follow",     "fps",
                             "layout",    "engine",         "weights", "out",       "format",     "canvas",
                             "points",    "engine-weights", "report",  "pose-file", "stick-width"};
  static const Names in_space = {"up", "units", "height", "turn", "floor"};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_single_name();
    if (option->count() == 0) continue;
    const bool is_of_pictures = in_picture.count(name) > 0;
    US_CHECK(use == FlatUse::InPicture || !is_of_pictures, "--", name,
             ": is of 2D poses performed by somebody in a picture, which this target is not");
    US_CHECK(use != FlatUse::InPicture || is_of_pictures || also.count(name) > 0, "--", name,
             ": has no meaning for 2D poses that somebody in a picture performs");
    US_CHECK(use != FlatUse::Lifted || in_space.count(name) == 0, "--", name,
             ": has no meaning for 2D poses, whose size is told by --stature");
    US_CHECK(use != FlatUse::None || name != "smoothing", "--", name, ": is of 2D poses");
  }
}

void run_flat_job(const JobOptions& job, FlatOptions flat) {
  flat.engine = flat_engine(job.how);
  flat.source.path = job.source.path;
  flat.source.fps = job.source.fps;
  if (job.poses.canvas) flat.source.canvas = *job.poses.canvas;
  flat.source.person = job.source.person;
  flat.source.layout = job.source.layout;
  flat.target.path = job.target.path;
  check_not_read(job.out, {flat.source.path, flat.target.path});
  US_CHECK(!job.source.follow || std::filesystem::is_directory(flat.source.path), flat.source.path,
           ": only a folder of 2D poses can be followed");
  const std::string suffix = file_suffix(job.source.path);
  const bool may_be_poses = suffix == ".json" || suffix == ".npy" || suffix == ".npz" ||
                            std::filesystem::is_directory(job.source.path);
  US_CHECK(may_be_poses || is_keypoint_source(job.source), job.source.path,
           ": is no 2D poses, and somebody in a picture (", job.target.path, ") performs nothing else");
  if (!job.out.empty()) check_flat_output(job.out);
  US_CHECK(job.format.empty() || job.format == "poses" || job.format == "pose_list", "--format ", job.format,
           ": is of what moves in space; 2D poses are written by the suffix of --out");
  const FlatTools tools = flat_tools(job.how);
  const FlatPerformance made =
      job.source.follow ? follow_and_write(job, flat, tools) : perform_and_write(job, flat, tools);
  for (const std::string& sentence : made.told) log::info(sentence);
  if (made.flagged > 0)
    log::warn(made.flagged == 1
                  ? std::string("1 frame could not be used and repeats the pose before")
                  : grouped(made.flagged) + " frames could not be used and repeat the pose before");
  if (!job.report.empty()) write_flat_report(job.report, made, job.how);
}

}  // namespace understudy::app
