#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "app/cli/commands.hpp"
#include "app/cli/pose_rows.hpp"
#include "app/cli/studio.hpp"
#include "app/run/exports.hpp"
#include "app/run/flat_performance.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/rig_performance.hpp"
#include "app/run/source.hpp"
#include "app/stimuli/stage.hpp"
#include "render/colors.hpp"
#include "render/contact_sheet.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/rest_pose.hpp"

namespace understudy::app {
namespace {

constexpr int kMostMoments = 240;

struct SheetCommand {
  std::vector<std::string> paths, captions;
  std::string motion, out, title, weights;
  double every_s = 1.0 / 6, from_s = 0;
  std::optional<double> seconds;  ///< none: to the end
  double angle_deg = 33;          ///< from ahead of them to their right
  int columns = 12;
  bool bones = false;
};

/// What is on a sheet.
struct SheetContent {
  std::vector<render::StripRow> rows;
  std::vector<double> times;
  float yaw = 0;
  std::string title;
};

/// A file, and how far into it its row begins: FILE@SECONDS.
struct SheetFile {
  std::string path;
  double from_s = 0;
};

SheetFile file_of(const std::string& text) {
  const size_t at = text.rfind('@');
  double from_s = 0;
  if (at == std::string::npos || !parse_number(text.substr(at + 1), from_s) || from_s < 0) return {text};
  return {text.substr(0, at), from_s};
}

/// Times from `from_s` on, of what lasts `length_s`.
std::vector<double> sheet_times(const SheetCommand& command, double length_s) {
  const double end = std::min(length_s, command.from_s + command.seconds.value_or(length_s));
  US_CHECK(command.from_s <= length_s, "--from ", command.from_s, ": it lasts ", printed("%.2f", length_s),
           " s");
  std::vector<double> times;
  for (int i = 0; command.from_s + i * command.every_s <= end + 1e-6; ++i) {
    US_CHECK(i < kMostMoments, "--every ", command.every_s, ": there would be more than ", kMostMoments,
             " moments");
    times.push_back(command.from_s + i * command.every_s);
  }
  return times;
}

template <class Rows>
void name_rows(const SheetCommand& command, Rows& rows) {
  US_CHECK(command.captions.empty() || command.captions.size() == rows.size(), "--captions has ",
           command.captions.size(), ", the sheet ", rows.size(), " rows");
  for (size_t i = 0; i < command.captions.size(); ++i) rows[i].caption = command.captions[i];
}

render::StripMoment moment_of(const SourceFrame& frame) {
  render::StripMoment moment;
  if (!frame.mesh.is_cloud() || !frame.skeleton)
    moment.mesh = frame.mesh;
  else
    moment.skeleton = render::skeleton_view(frame.skeleton->joints);
  return moment;
}

/// Leaves in `facing` where the first one who is seen faces, where that is known.
render::StripRow row_of(Source& source, std::vector<double> times, double from_s,
                        std::optional<float>& facing) {
  for (double& time : times) time += from_s;
  render::StripRow row;
  row.moments.resize(times.size());
  render::StripMoment last;
  size_t filled = 0;
  for (int64_t i = 0; filled < times.size(); ++i) {
    check_interrupt("after frame " + std::to_string(i));
    const auto frame = source.next();
    if (!frame) break;
    const auto is_now = [&] {
      return filled < times.size() && std::lround(times[filled] * source.fps()) <= i;
    };
    if (!is_now()) continue;
    if (frame->usable) last = moment_of(*frame);
    if (!facing && frame->skeleton) facing = heading_of_joints(frame->skeleton->joints);
    while (is_now()) row.moments[filled++] = last;
  }
  return row;
}

/// A row a file.
SheetContent content_of_files(const SheetCommand& command) {
  std::vector<std::unique_ptr<Source>> sources;
  double length_s = 0;
  std::vector<SheetFile> files;
  for (const std::string& text : command.paths) {
    const SheetFile& file = files.emplace_back(file_of(text));
    SourceOptions options;
    options.path = file.path;
    options.quiet = true;
    sources.push_back(open_source(options));
    const auto count = sources.back()->count();
    US_CHECK(count, file.path, ": nobody knows how long it is");
    length_s = std::max(length_s, static_cast<double>(*count - 1) / sources.back()->fps() - file.from_s);
  }
  SheetContent content;
  content.times = sheet_times(command, length_s);
  std::optional<float> facing;
  for (size_t i = 0; i < sources.size(); ++i) {
    content.rows.push_back(row_of(*sources[i], content.times, files[i].from_s, facing));
    content.rows.back().caption = std::filesystem::path(files[i].path).stem().string();
  }
  content.yaw = facing.value_or(0) - static_cast<float>(command.angle_deg) * kPi / 180;
  return content;
}

/// The same colour for the same name on all of a sheet: the next one of the categories; when they are used up
/// the same again, darker.
class NameColors {
 public:
  Vec3 of(const std::string& name) {
    const size_t i = numbers_.try_emplace(name, numbers_.size()).first->second;
    constexpr size_t kCount = render::kCategories.size();
    const size_t rounds = i / kCount;
    return std::pow(0.55f, static_cast<float>(rounds)) * render::kCategories[i % kCount];
  }

 private:
  std::map<std::string, size_t> numbers_;
};

/// A rig in a pose, as large as every other one, its joints marked.
render::StripMoment moment_of(const RiggedMotion& body, size_t frame, NameColors& colors) {
  constexpr float kAdult = 2;  // diagonal of an adult's box, metres
  const understudy::Rig& rig = body.rig;
  const float scale = kAdult / std::max(1e-6f, box_diagonal(rig.surface.vertices));
  const BoneMotions bones = bone_motions(rig, body.motion.poses[frame]);
  render::StripMoment moment;
  moment.mesh = {scale * skinned(rig.surface.vertices, rig.skin, bones), rig.surface.faces};
  render::SkeletonView& skeleton = moment.skeleton.emplace();
  skeleton.joints = scale * joint_places(rig, bones);
  skeleton.colors.resize(rig.count(), 3);
  for (const RigJoint& joint : rig.joints) {
    skeleton.colors.row(static_cast<Eigen::Index>(skeleton.parents.size())) =
        colors.of(joint.name).transpose();
    skeleton.parents.push_back(joint.parent);
  }
  return moment;
}

/// A row a rig.
SheetContent content_of_rigs(const SheetCommand& command) {
  std::vector<RiggedMotion> rigs;
  std::vector<SheetFile> files;
  double length_s = 0;
  for (const std::string& text : command.paths) {
    const SheetFile& file = files.emplace_back(file_of(text));
    const RiggedMotion& rig = rigs.emplace_back(read_rig(file.path));
    length_s =
        std::max(length_s, static_cast<double>(rig.motion.poses.size() - 1) / rig.motion.fps - file.from_s);
  }
  SheetContent content;
  content.times = sheet_times(command, length_s);
  NameColors colors;
  for (size_t i = 0; i < rigs.size(); ++i) {
    render::StripRow& row = content.rows.emplace_back();
    row.caption = std::filesystem::path(files[i].path).stem().string();
    for (const double time : content.times) {
      const auto frame = static_cast<size_t>(std::lround((time + files[i].from_s) * rigs[i].motion.fps));
      row.moments.push_back(frame < rigs[i].motion.poses.size() ? moment_of(rigs[i], frame, colors)
                                                                : render::StripMoment{});
    }
  }
  content.yaw = -static_cast<float>(command.angle_deg) * kPi / 180;
  return content;
}

render::StripRow row_of(const MovingSurface& surface, const std::string& caption,
                        const std::vector<double>& times) {
  render::StripRow row;
  row.caption = caption;
  row.color = surface.color;
  for (const double time : times) {
    row.moments.emplace_back();
    if (std::lround(time * surface.fps) >= static_cast<int64_t>(surface.frames.size())) continue;
    const SurfaceFrame& frame = surface.at(time);
    if (frame.skeleton)
      row.moments.back().skeleton = render::skeleton_view(*frame.skeleton);
    else
      row.moments.back().mesh = {*frame.vertices, *frame.faces, *frame.colors};
  }
  return row;
}

int motion_called(const Study& study, const std::string& name) {
  std::string names;
  for (size_t i = 0; i < study.motions.size(); ++i) {
    if (name.empty() || study.motions[i].name == name) return static_cast<int>(i);
    append_item(names, study.motions[i].name);
  }
  throw Error("--motion " + name + ": the study has none of this name, only " + names);
}

/// The source, and a row for each target in each condition, from where the study's clips are seen.
SheetContent content_of_study(const SheetCommand& command) {
  const Study study = read_study(command.paths[0]);
  check_files(study);
  const int motion = motion_called(study, command.motion);
  const StudioServices program = studio_services(command.weights);
  StageMaker maker(study, {program.networks,
                           [](const std::string& what, int64_t done, int64_t) {
                             check_interrupt(what + ", after frame " + std::to_string(done));
                           },
                           program.motion_coder});
  SheetContent content;
  content.yaw = study.picture.yaw_deg * kPi / 180;
  content.title = study.name + ": " + study.motions[static_cast<size_t>(motion)].name;
  for (size_t t = 0; t < study.targets.size(); ++t) {
    const auto stage = maker.stage(motion, static_cast<int>(t));
    if (t == 0) {
      content.times = sheet_times(command, stage->motion_s - 1 / stage->source.fps);
      content.rows.push_back(row_of(stage->source, "source", content.times));
    }
    for (size_t i = 0; i < study.conditions.size(); ++i)
      content.rows.push_back(
          row_of(stage->results[i],
                 study.conditions[i].name + (study.targets.size() > 1 ? ", " + study.targets[t].name : ""),
                 content.times));
  }
  return content;
}

/// A row that is flat in itself: 2D poses, or a folder of pictures.
struct FlatRow {
  std::string path;
  double from_s = 0;
  std::optional<KeypointReading> reading;  ///< none: pictures

  double length_s() const {
    return reading ? static_cast<double>(reading->frames.size() - 1) / reading->fps
                   : static_cast<double>(count_pictures(path) - 1) / kPictureRate;
  }
  render::PictureRow at(std::vector<double> times, int width) const {
    for (double& time : times) time += from_s;
    return reading ? pose_row(*reading, times, width) : picture_row(path, times, width);
  }
};

bool is_flat_row(const std::string& text) {
  return is_folder_of_pictures(file_of(text).path) || looks_like_keypoints(file_of(text).path);
}

FlatRow flat_row(const std::string& text) {
  const SheetFile file = file_of(text);
  FlatRow row{file.path, file.from_s, {}};
  if (is_folder_of_pictures(file.path)) return row;
  FlatSourceOptions options;
  options.path = file.path;
  row.reading = open_keypoints(options);
  return row;
}

int make_flat_sheet(const SheetCommand& command) {
  std::vector<FlatRow> files;
  double length_s = 0;
  for (const std::string& text : command.paths) {
    files.push_back(flat_row(text));
    length_s = std::max(length_s, files.back().length_s() - files.back().from_s);
  }
  const std::vector<double> times = sheet_times(command, length_s);
  render::StripOptions options;
  options.title = command.title;
  options.columns = command.columns;
  const int width = render::picture_width(options, static_cast<int>(times.size()));
  std::vector<render::PictureRow> rows;
  rows.reserve(files.size());
  for (const FlatRow& file : files) rows.push_back(file.at(times, width));
  name_rows(command, rows);
  std::vector<std::string> headers;
  headers.reserve(times.size());
  for (const double time : times) headers.push_back(printed("%.2f s", time));
  render::write_png(command.out, render::picture_sheet(rows, headers, options));
  std::printf("%s: %zu rows, %zu moments\n", command.out.c_str(), rows.size(), times.size());
  return 0;
}

int make_sheet(const SheetCommand& command) {
  check_writable(command.out);
  for (const std::string& text : command.paths) check_not_read(command.out, {file_of(text).path});
  const bool study = file_suffix(command.paths[0]) == ".study";
  US_CHECK(!study || command.paths.size() == 1, command.paths[0], ": a study is shown by itself");
  US_CHECK(study || command.motion.empty(), "--motion is of a study");
  US_CHECK(!study || !command.bones, "--bones is of rigs, not of a study");
  if (!study && !command.bones && std::all_of(command.paths.begin(), command.paths.end(), is_flat_row))
    return make_flat_sheet(command);
  SheetContent content = study           ? content_of_study(command)
                         : command.bones ? content_of_rigs(command)
                                         : content_of_files(command);
  name_rows(command, content.rows);
  content.rows[0].color = render::SheetOptions().source_color;
  render::StripOptions options;
  options.title = command.title.empty() ? content.title : command.title;
  options.yaw = content.yaw;
  options.columns = command.columns;
  render::write_png(command.out, render::strip(content.rows, content.times, options));
  std::printf("%s: %zu rows, %zu moments\n", command.out.c_str(), content.rows.size(), content.times.size());
  return 0;
}

}  // namespace

Action declare_sheet(CLI::App& app) {
  const auto command = std::make_shared<SheetCommand>();
  app.add_option("FILE", command->paths,
                 "a row each: animated characters, skeletal motions, scans; 2D poses, folders of PNGs (30 a "
                 "second); or one .study, with a row for "
                 "its source and each of its conditions")
      ->required();
  app.add_option("--out", command->out, "the picture, .png")->required();
  app.add_option("--every", command->every_s, "seconds from moment to moment (default: a sixth)")
      ->check(CLI::Range(0.001, 60.0));
  app.add_option("--from", command->from_s, "the first moment, seconds (default: 0)")
      ->check(CLI::Range(0.0, 1e5));
  app.add_option("--seconds", command->seconds,
                 "how long; 0: one moment, all side by side (default: to the end of the longest)")
      ->check(CLI::Range(0.0, 1e5));
  app.add_option("--captions", command->captions, "of the rows (default: the files' names)")->delimiter(',');
  app.add_option("--title", command->title, "over all of it");
  app.add_option("--angle", command->angle_deg,
                 "of files: degrees from ahead of who moves to their right (default: 33)")
      ->check(CLI::Range(-180.0, 180.0));
  app.add_option("--columns", command->columns, "moments beside each other; more go on below (default: 12)")
      ->check(CLI::Range(1, 60));
  app.add_flag(
      "--bones", command->bones,
      "the files are rigs (.glb, .gltf): with their joints, those of one name in one colour, each rig "
      "as large as the others");
  app.add_option("--motion", command->motion, "of a study (default: its first)");
  app.add_option("--weights", command->weights, "folder of the weights (default: beside the program)");
  return [command] { return make_sheet(*command); };
}

}  // namespace understudy::app
