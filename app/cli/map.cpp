#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/studio.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/step_index.hpp"
#include "app/session/settings.hpp"
#include "render/colors.hpp"
#include "render/map_plot.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

struct MapOptions {
  std::vector<std::string> paths;
  std::string out, csv, report, color = "action", like, index, weights;
  std::string of = kMapOfNames[0];
  int count = 8;
};

MapColour colour_named(const std::string& name) {
  for (size_t i = 0; i < kMapColourNames.size(); ++i)
    if (name == kMapColourNames[i]) return static_cast<MapColour>(i);
  throw Error("--color " + name + ": is not action, speed, duration or file");
}

/// FILE@FIRST:LAST.
MotionRange range_asked(const std::string& text) {
  const size_t at = text.rfind('@'), colon = text.rfind(':');
  int64_t first = 0, last = 0;
  US_CHECK(at != std::string::npos && colon != std::string::npos && at < colon &&
               parse_integer(text.substr(at + 1, colon - at - 1), first) &&
               parse_integer(text.substr(colon + 1), last) && first >= 0 && first < last &&
               last <= kFrameNumbers.high,
           "--like ", text, ": is not FILE@FIRST:LAST, a file and two numbers of frames, the later one last");
  MotionRange range;
  range.path = std::filesystem::absolute(text.substr(0, at)).lexically_normal().string();
  range.first = static_cast<int>(first), range.last = static_cast<int>(last);
  return range;
}

MapOf kind_of(const MapOptions& options) {
  return options.of == kMapOfNames[0] ? MapOf::Steps : MapOf::Others;
}

IndexedSteps indexed(const MapOptions& options, MapEncoders& encoders) {
  const std::vector<std::string> files = motion_files(options.paths);
  Progress progress("reading motions", ssize(files), false, "file");
  StepIndexOptions how;
  how.folder = options.index.empty() ? state_folder() + "/steps" : options.index;
  how.progress = [&](int done, int of) {
    US_CHECK(!interrupted(), "interrupted after ", done, " of ", of,
             " files; what was read is kept for the next time");
    progress.step(done);
  };
  IndexedSteps steps = index_steps(files, encoders, how);
  progress.finish();
  return steps;
}

/// What could not be used, a line each.
void name_left_out(const IndexedSteps& steps) {
  log::Tally problems, still;
  for (const std::string& problem : steps.problems) problems.warn(problem);
  problems.finish();
  for (const std::string& file : steps.without_steps) still.warn(file + ": nobody steps in it");
  still.finish();
}

Vec3 group_color(int group) {
  static const Vec3 kColors[] = {{0.12f, 0.42f, 0.70f}, {0.85f, 0.37f, 0.12f}, {0.17f, 0.58f, 0.31f},
                                 {0.55f, 0.30f, 0.66f}, {0.70f, 0.58f, 0.05f}, {0.80f, 0.22f, 0.42f},
                                 {0.10f, 0.62f, 0.65f}, {0.47f, 0.33f, 0.22f}};
  static_assert(std::size(kColors) == kMapGroups);
  return group < 0 ? Vec3(0.60f, 0.62f, 0.65f) : kColors[group];
}

/// Viridis without its palest end, which white paper swallows.
Vec3 scale_color(float share) {
  return render::viridis(0.92f * share);
}

void write_picture(const MapOptions& options, const MotionMap& map, const std::vector<NearStep>& like) {
  const MapColour by = colour_named(options.color);
  const MapColouring colouring = map_colouring(map, by);
  std::vector<render::MapPoint> points;
  bool any_other = false;
  for (int i = 0; i < map.size(); ++i) {
    const bool grouped_by = !colouring.groups.empty();
    any_other = any_other || (grouped_by && colouring.group[i] < 0);
    points.push_back(
        {map.place(i), grouped_by ? group_color(colouring.group[i]) : scale_color(colouring.value[i])});
  }
  render::MapPlotOptions plot;
  const bool steps = kind_of(options) == MapOf::Steps;
  plot.title = steps ? "Steps by their likeness" : "Movements that are no steps, by their likeness";
  plot.subtitle = grouped(map.size()) + (steps ? " steps in " : " stretches in ") +
                  grouped(ssize(map.motions())) + " motions; each figure at the end of its " +
                  (steps ? "step, " : "stretch, ") +
                  (like.empty() ? "its beginning behind it" : "numbered: those most like " + options.like);
  const auto axis = [&](int k) {
    return printed("component %d (%.0f %% of the variance)", k + 1,
                   100 * static_cast<double>(map.shares()[static_cast<size_t>(k)]));
  };
  plot.x_label = axis(0), plot.y_label = axis(1);
  for (size_t g = 0; g < colouring.groups.size(); ++g)
    plot.legend.emplace_back(colouring.groups[g], group_color(static_cast<int>(g)));
  if (any_other) plot.legend.emplace_back("others", group_color(-1));
  if (colouring.groups.empty())
    plot.scale = {scale_color, colouring.low, colouring.high, options.color + ", " + colouring.unit};
  for (const NearStep& near : like) plot.marked.push_back(near.step);
  plot.figure = [&map](int i) {
    const MappedStep& step = map.step(i);
    std::vector<Joints> moments;
    for (const float share : {0.05f, 0.35f, 0.65f, 0.95f})
      moments.push_back(figure_at(step, map.motion_of(i).rest, share * step.seconds, /*in_place=*/false));
    return moments;
  };
  render::write_png(options.out, render::map_plot(points, plot));
}

void write_table(const MapOptions& options, const MotionMap& map) {
  std::string text = "step,file,animation,first,last,action,seconds,speed_m_s,foot,x,y\n";
  for (int i = 0; i < map.size(); ++i) {
    const MappedMotion& motion = map.motion_of(i);
    const MappedStep& step = map.step(i);
    text += printed("%d,%s,%s,%d,%d,%s,%.3f,%.3f,%s,%.5f,%.5f\n", i, csv_cell(motion.path).c_str(),
                    motion.clip.c_str(), step.first, step.last, csv_cell(motion.action).c_str(),
                    static_cast<double>(step.seconds), static_cast<double>(step.speed_m_s),
                    kind_of(options) == MapOf::Others ? ""
                    : step.left_first                 ? "left"
                                                      : "right",
                    static_cast<double>(map.place(i).x()), static_cast<double>(map.place(i).y()));
  }
  write_file(options.csv, text);
}

Json report_of(const MapOptions& options, const IndexedSteps& steps, const MotionMap& map,
               const std::vector<NearStep>& like) {
  nn::NetworkOptions networks;
  networks.weights = options.weights;
  Json report = report_header(nn::weights_folder(networks));
  report["coder"] = steps.coder;
  report["of"] = options.of;
  report["files"] = steps.files;
  report["read_anew"] = steps.read;
  report["damaged_entries"] = steps.damaged;
  report["motions"] = map.motions().size();
  report["steps"] = map.size();
  report["neighbour_distance"] = map.neighbour_distance();
  report["variance"] = map.shares();
  report["like"] = Json::array();
  for (const NearStep& near : like)
    report["like"].push_back({{"file", map.motion_of(near.step).path},
                              {"animation", map.motion_of(near.step).clip},
                              {"first", map.step(near.step).first},
                              {"last", map.step(near.step).last},
                              {"distance", near.distance}});
  report["without_steps"] = steps.without_steps;
  report["problems"] = steps.problems;
  return report;
}

void check_outputs(const MapOptions& options) {
  US_CHECK(!options.out.empty() || !options.csv.empty() || !options.report.empty() || !options.like.empty(),
           "nothing is to be written: name a picture (--out), a table (--csv) or a report (--report), or ask "
           "for what is alike (--like)");
  US_CHECK(options.out.empty() || file_suffix(options.out) == ".png", options.out,
           ": is no picture that can be written, only .png");
  for (const std::string& path : {options.out, options.csv, options.report}) {
    check_not_read(path, options.paths);
    check_writable(path);
  }
}

int map(MapOptions options) {
  check_outputs(options);
  colour_named(options.color);
  std::optional<MotionRange> range;
  if (!options.like.empty()) range = range_asked(options.like);
  MethodOptions how;
  how.weights = options.weights;
  MapEncoders encoders(coder_loader(options.weights), motion_space_loader(how));
  IndexedSteps steps = indexed(options, encoders);
  name_left_out(steps);
  US_CHECK(steps.files > 0, options.paths.front(), ": holds no skeletal motion (", format_names(kMotion),
           ")");
  std::printf("%s\n", index_words(steps).c_str());
  const MapOf kind = kind_of(options);
  const MotionMap all(std::move(kind == MapOf::Steps ? steps.motions : steps.others));
  US_CHECK(all.size() > 0, kind == MapOf::Steps ? "nobody steps in any of these motions"
                                                : "there is nothing but steps in these motions");
  std::vector<NearStep> like;
  if (range) {
    range->motion = read_file_motion(range->path, "");
    like = like_this(all, kind, *range, encoders, options.count);
  }
  for (const NearStep& near : like)
    std::printf("%s: %s\n", step_words(all, near.step).c_str(), distance_words(near.distance).c_str());
  if (!options.out.empty()) write_picture(options, all, like);
  if (!options.csv.empty()) write_table(options, all);
  if (!options.report.empty()) write_json(options.report, report_of(options, steps, all, like));
  return 0;
}

}  // namespace

Action declare_map(CLI::App& command) {
  const auto options = std::make_shared<MapOptions>();
  command
      .add_option("PATHS", options->paths,
                  "skeletal motions (" + format_names(kMotion) +
                      ") and folders of them; folders inside are looked into")
      ->required();
  command
      .add_option("--of", options->of, "what is on the map: steps, or others: movements that are no steps")
      ->check(CLI::IsMember({"steps", "others"}));
  command.add_option("--out", options->out, "the map as PNG");
  command.add_option("--csv", options->csv, "all steps as a table: file, frames, speed, place on the map");
  command
      .add_option("--color", options->color,
                  "what the colours tell: action, speed, duration or file (default: action)")
      ->check(CLI::IsMember({"action", "speed", "duration", "file"}));
  command.add_option("--like", options->like,
                     "FILE@FIRST:LAST: names the steps most like those in these frames");
  command.add_option("--count", options->count, "how many of them (default: 8)")->check(CLI::Range(1, 1000));
  command.add_option("--report", options->report, "what was read, and what is alike, as JSON");
  command.add_option("--index", options->index,
                     "folder that remembers what was read (default: among the program's own files)");
  command.add_option("--weights", options->weights, "folder of the weights (default: beside the program)");
  return [options] { return map(*options); };
}

}  // namespace understudy::app
