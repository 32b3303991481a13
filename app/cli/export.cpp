#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/preview.hpp"
#include "app/cli/progress.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/performer.hpp"
#include "app/run/report.hpp"
#include "render/contact_sheet.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/character/character_export.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy::app {
namespace {

struct ExportOptions {
  std::vector<std::string> sources;
  std::string target, out, map_file, preview, report;
  SourceOptions source;  // what all sources share
  CharacterOptions character;
  CharacterExportOptions file;
  RetargetOptions retarget;
  nn::NetworkOptions networks;
  std::string rig = "auto";
  bool print_map = false;
  int64_t frames = 0;
};

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// {"left_wrist": "bone", ...}
BoneChoices read_choices(const std::string& path) {
  if (path.empty()) return {};
  const std::string text = read_file(path);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  US_CHECK(json.is_object(), path, R"(: is no map of bones; it looks like {"left_wrist": "Hand.L", ...})");
  BoneChoices choices;
  for (const auto& [joint, bone] : json.items()) {
    US_CHECK(bone.is_string(), path, ": the bone of '", excerpt(joint), "' is no text");
    choices[joint] = bone.get<std::string>();
  }
  return choices;
}

std::string clip_name(const std::string& source) {
  const std::filesystem::path normal = std::filesystem::path(source).lexically_normal();
  const std::string stem = (normal.has_filename() ? normal : normal.parent_path()).stem().string();
  return stem.empty() ? "motion" : stem;
}

/// One source to its end.
CharacterClip perform(const ExportOptions& options, const std::string& path, const Target& target,
                      Retargeter& retargeter) {
  SourceOptions one = options.source;
  one.path = path;
  const auto source = open_source(one);
  retargeter.set_target(target);
  CharacterClip clip{clip_name(path), source->fps(), {}};
  Progress progress(clip.name + " -> " + clip_name(options.target), source->count().value_or(0));
  int64_t flagged = 0;
  const auto dt = static_cast<float>(1 / source->fps());
  while (auto scan = source->next()) {
    const RetargetedFrame frame = retargeter.push(scan->mesh, dt);
    flagged += frame.flagged ? 1 : 0;
    clip.poses.push_back(frame.pose);
    progress.step(static_cast<int64_t>(clip.poses.size()));
    check_interrupt("after frame " + std::to_string(scan->number));
    if (options.frames > 0 && static_cast<int64_t>(clip.poses.size()) >= options.frames) break;
  }
  progress.finish();
  check_interrupt("after " + std::to_string(clip.poses.size()) + " frames");
  US_CHECK(static_cast<int64_t>(clip.poses.size()) > flagged, path, ": no frame in it could be used");
  if (flagged > 0)
    log::warn(path + ": " + std::to_string(flagged) +
              " of its frames could not be used and repeat the last pose");
  return clip;
}

/// Six moments of the first clip as the file has them, and how it stands in the T-pose.
void preview_file(const ExportOptions& options, const PreparedCharacter& prepared,
                  const CharacterClip& clip) {
  const Character written = parse_gltf_character(read_file(options.out), options.out);
  const int animation = options.file.t_pose_clip ? 1 : 0;
  // The sheet looks from where the motion begins; the T-pose turns along.
  const float heading = heading_of_joints(forward_kinematics(prepared.target.joints, clip.poses[0]).joints);
  const Mat3 turn = rotation_about_y(heading);
  Mesh rest = prepared.target.mesh;
  rest.vertices = (rest.vertices * turn.transpose()).eval();
  std::vector<render::SheetMoment> moments;
  const size_t shown = std::min<size_t>(PreviewMoments::kShown, clip.poses.size());
  for (size_t i = 0; i < shown; ++i) {
    const size_t at = shown == 1 ? 0 : i * (clip.poses.size() - 1) / (shown - 1);
    render::SheetMoment moment;
    moment.frame = static_cast<int>(at);
    moment.seconds = static_cast<double>(at) / clip.fps;
    moment.source = rest;
    moment.source_joints = Joints(prepared.target.joints * turn.transpose());
    moment.target =
        merged_surface(written, vertices_at(written, animation, static_cast<float>(moment.seconds))).mesh;
    moments.push_back(std::move(moment));
  }
  render::SheetOptions sheet;
  sheet.title = clip.name + " by " + clip_name(options.target);
  sheet.heading = heading;
  sheet.source_caption = "T-pose";
  sheet.target_caption = "Written file";
  render::write_png(options.preview, render::contact_sheet(moments, sheet));
}

void report_cost(const ExportOptions& options, const PreparedCharacter& prepared, const ExportCost& cost) {
  std::printf(
      "%s %lld bytes, against the screen: mean %.3f mm, largest %.3f mm over %lld frames, %lld keys\n",
      options.out.c_str(), static_cast<long long>(cost.bytes), cost.mean_mm, cost.largest_mm,
      static_cast<long long>(cost.frames), static_cast<long long>(cost.keys));
  if (options.report.empty()) return;
  Json report = report_header(nn::weights_folder(options.networks));
  report["target"] = options.target;
  report["rig"] = options.file.their_rig ? "theirs" : "ours";
  report["mapped"] = prepared.map.count();
  report["notes"] = prepared.notes;
  report["cost"] = {{"mean_mm", cost.mean_mm},
                    {"largest_mm", cost.largest_mm},
                    {"frames", cost.frames},
                    {"keys", cost.keys},
                    {"bytes", cost.bytes}};
  write_json(options.report, report);
}

void choose_rig(ExportOptions& options, const PreparedCharacter& prepared) {
  US_CHECK(options.rig != "theirs" || prepared.rigged, options.target,
           ": has no skeleton whose bones are known; --print-map shows them, --map names them");
  options.file.their_rig = options.rig != "ours" && prepared.rigged;
  for (const std::string& note : prepared.notes) log::info(options.target + ": " + note);
  if (prepared.rigged)
    log::info(options.target + ": " + std::to_string(prepared.map.count()) + " of 22 joints are mapped " +
              prepared.map.how);
}

int print_map(const ExportOptions& options) {
  const Character character = read_character(options.target);
  const BoneMap map = map_bones(character, bind_pose(character).nodes, options.character.choices);
  std::printf("%s", to_table(map, character).c_str());
  US_CHECK(map.usable(), options.target, ": too few of its bones are known to drive it");
  return 0;
}

int run_export(ExportOptions options) {
  options.character.choices = read_choices(options.map_file);
  if (options.print_map) return print_map(options);
  US_CHECK(ends_with(options.out, ".glb") || ends_with(options.out, ".gltf"), options.out,
           ": this output format is not known, use .glb or .gltf");
  US_CHECK(!options.sources.empty(), "--source: a motion to perform is wanted");
  for (const std::string& path : {options.out, options.preview, options.report}) check_writable(path);
  options.character.own_joints = options.rig != "ours";
  Character character = read_character(options.target);
  Networks networks = nn::load_networks(options.networks);
  const PreparedCharacter prepared = prepare_character(std::move(character), networks.extractor.get(),
                                                       networks.rest_extractor.get(), options.character);
  choose_rig(options, prepared);
  Retargeter retargeter(networks_for(std::move(networks), prepared, options.file.their_rig), [&] {
    RetargetOptions quick = options.retarget;
    quick.vertices = false;
    return quick;
  }());
  std::vector<CharacterClip> clips;
  for (const std::string& path : options.sources)
    clips.push_back(perform(options, path, prepared.target, retargeter));
  const auto began = std::chrono::steady_clock::now();
  const ExportCost cost =
      export_character(options.out, prepared, *retargeter.networks().deformer, clips, options.file);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::fprintf(stderr, "written and measured in %.2f s\n", seconds);
  report_cost(options, prepared, cost);
  if (!options.preview.empty()) preview_file(options, prepared, clips[0]);
  return 0;
}

void add_file_options(CLI::App& command, ExportOptions& options) {
  command
      .add_option("--rig", options.rig,
                  "theirs: the character's own skeleton; ours: 22 joints (default: theirs, if any)")
      ->check(CLI::IsMember({"auto", "theirs", "ours"}));
  command.add_option("--influences", options.file.influences, "bones a vertex on our rig: 4 or 8")
      ->check(CLI::IsMember({4, 8}));
  command.add_option("--morphs", options.file.shapes, "morph targets for the pose-corrective offsets")
      ->check(CLI::Range(0, 64));
  command.add_option("--reduce", options.file.reduce_mm, "leave out keys, at most this far off, mm")
      ->check(CLI::Range(0.0, 1000.0));
  command.add_flag("--in-place", options.file.in_place, "without the path over the floor");
  command.add_flag("--t-pose-clip", options.file.t_pose_clip, "the first clip is the T-pose");
  command.add_flag("--keep-clips", options.file.keep_clips, "keep the file's own animations");
  command.add_option("--frames", options.frames, "only so many frames of each source")
      ->check(CLI::Range(1, 100000000));
}

}  // namespace

Action declare_export(CLI::App& command) {
  const auto options = std::make_shared<ExportOptions>();
  command.add_option("--source", options->sources, "scans to perform; several become several clips");
  command.add_option("--target", options->target, "a character: GLB, glTF, FBX, DAE, OBJ, PLY, OFF, STL")
      ->required();
  command.add_option("--out", options->out, "the animated character: .glb or .gltf");
  command.add_option("--map", options->map_file, R"(JSON that names bones: {"left_wrist": "Hand.L"})");
  command.add_flag("--print-map", options->print_map, "show which bone is which joint, and stop");
  command.add_option("--preview", options->preview, "contact sheet of the written file as PNG");
  command.add_option("--report", options->report, "what it costs, as JSON");
  command.add_option("--target-units", options->character.units,
                     "the character's units: auto, m, dm, cm, mm, in");
  command.add_option("--target-up", options->character.up,
                     "the character's up axis: auto, y (default), z, ...");
  command.add_option("--target-yaw", options->character.yaw_deg,
                     "turns the character, degrees (default: to the front)");
  command.add_option("--fps", options->source.fps, "frames per second of the sources")
      ->check(CLI::Range(1.0, 1000.0));
  add_file_options(command, *options);
  add_network_options(command, options->networks);
  return [options] {
    if (options->rig == "ours" && options->print_map) options->rig = "auto";
    return run_export(*options);
  };
}

}  // namespace understudy::app
