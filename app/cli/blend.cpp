#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/cli/headless.hpp"
#include "app/cli/options.hpp"
#include "app/cli/studio.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/motion_blender.hpp"
#include "app/run/report.hpp"
#include "app/run/retargeted_source.hpp"
#include "render/ghost_sheet.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/motion_space/blend.hpp"

namespace understudy::app {
namespace {

struct BlendOptions {
  std::vector<std::string> parts;
  std::string shares, coder = BlendRecipe().coder;
  int steps = 0, cycles = 1;  // steps 0: not given
  double fps = 0;
  TargetOptions target;
  MethodOptions how;
  std::string out, report, preview;
};

/// One blend, performed.
struct BlendStep {
  BlendedMotion source;
  std::vector<float> weights;
  CharacterClip clip;
  std::vector<Joints> source_joints;
  JointSequence joints, made;  // of the target, and of what it follows
};

/// Who performs, and where it is written.
struct Stage {
  std::shared_ptr<const PreparedCharacter> character;
  std::unique_ptr<Retargeter> retargeter;
  const ExportFormat* format;
};

Stage open_stage(const BlendOptions& options, const ExportFormat& format) {
  Networks networks = nn::load_networks(network_options(options.how));
  Stage stage{open_target(options.target, networks), nullptr, &format};
  RetargetOptions quick = retarget_options(options.how);
  quick.vertices = false;
  stage.retargeter = std::make_unique<Retargeter>(
      networks_for(std::move(networks), *stage.character, on_their_rig(options.target, *stage.character)),
      quick);
  stage.retargeter->set_target(stage.character->target);
  return stage;
}

BlendRecipe recipe_of(const BlendOptions& options) {
  BlendRecipe blend;
  for (const std::string& part : options.parts) blend.parts.push_back(blend_part(part));
  blend.cycles = options.cycles;
  blend.coder = options.coder;
  return blend;
}

std::vector<std::vector<float>> weights_of(const BlendOptions& options) {
  constexpr int kSteps = 5;
  US_CHECK(options.shares.empty() || options.steps == 0,
           "--shares gives one blend, --steps a line of them: only one of both can be told");
  if (!options.shares.empty()) return {blend_weights(options.shares)};
  return weights_along(options.parts.size(), options.steps == 0 ? kSteps : options.steps);
}

/// What a part is called among the others: by its file, and by its frames where another has that name.
std::string label_of(const BlendRecipe& blend, size_t i) {
  std::string name = clip_name(blend.parts[i].path);
  const auto same_name = [&](const BlendPart& part) { return clip_name(part.path) == name; };
  if (std::count_if(blend.parts.begin(), blend.parts.end(), same_name) == 1) return name;
  const std::string frames = in_words(blend.parts[i]).substr(blend.parts[i].path.size());
  return name + (frames.empty() ? " " + std::to_string(i + 1) : frames);
}

/// "0.17 run": how much of the second of two; of more the shares of all that count.
std::string clip_name_of(const BlendRecipe& blend, const std::vector<float>& weights) {
  if (weights.size() == 2)
    return printed("%.2f ", static_cast<double>(weights[1] / (weights[0] + weights[1]))) + label_of(blend, 1);
  float sum = 0;
  for (const float weight : weights) sum += weight;
  std::string name;
  for (size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0)
      append_item(name, printed("%.2f ", static_cast<double>(weights[i] / sum)) + label_of(blend, i), " ");
  return name;
}

BlendStep perform_step(const BlendOptions& options, BlendRecipe blend, const std::vector<float>& weights,
                       Stage& stage, MotionBlender& blender) {
  set_weights(weights, blend);
  SourceOptions from = blended_source(blend);
  from.fps = options.fps;
  from.quiet = true;  // all steps have the same to tell
  BlendStep step;
  step.weights = weights;
  step.source = blender.make(blend, options.fps);
  const auto source = open_source(from, &blender);
  RetargetedSource retargeted(*source, *stage.retargeter, from);
  step.clip = {clip_name_of(blend, weights), source->fps(), {}};
  std::vector<float> doubt_m;
  while (const auto frame = retargeted.next()) {
    step.clip.poses.push_back(frame->result.pose);
    step.joints.push_back(frame->result.joints);
    step.made.push_back(frame->result.observed.joints);
    step.source_joints.push_back(source_joints(frame->result));
    doubt_m.push_back(frame->result.observed.doubt_m);
    check_interrupt("after " + step.clip.name);
  }
  step.clip.made = made_frames(doubt_m);
  return step;
}

/// Null where it is not known.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

double mean_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

Json parts_of(const BlendRecipe& blend, const BlendedMotion& made) {
  Json parts = Json::array();
  for (size_t i = 0; i < made.parts.size(); ++i) {
    const UsedPart& part = made.parts[i];
    parts.push_back({{"file", part.path},
                     {"checksum", blend.parts[i].checksum},
                     {"first", part.range.first},
                     {"last", part.range.last},
                     {"mirrored", part.mirrored},
                     {"seconds", part.seconds}});
  }
  return parts;
}

Json report_of(const BlendOptions& options, const BlendRecipe& blend, const std::vector<BlendStep>& steps) {
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  const BlendedMotion& first = steps.front().source;
  report["target"] = options.target.path;
  report["coder"] = first.coder;
  report["cycles"] = options.cycles;
  report["fps"] = steps.front().clip.fps;
  report["parts"] = parts_of(blend, first);
  report["notes"] = first.notes;
  report["warnings"] = first.warnings;
  report["steps"] = Json::array();
  for (const BlendStep& step : steps) {
    Json one{{"name", step.clip.name}, {"weights", step.weights}, {"seconds", step.source.seconds}};
    one["decoded_seconds"] = step.source.decoded_seconds;
    one["frames"] = step.clip.poses.size();
    one["doubt_m"] = mean_of(step.source.motion.doubt_m);
    one["foot_skate"] = number_or_null(foot_skate(step.joints, step.clip.fps));
    one["source_foot_skate"] = number_or_null(foot_skate(step.made, step.clip.fps));
    one["made_frames"] = Json::array();
    for (const MadeFrames& made : step.clip.made)
      one["made_frames"].push_back({{"first", made.first}, {"last", made.last}, {"doubt_m", made.doubt_m}});
    report["steps"].push_back(std::move(one));
  }
  return report;
}

/// Ghosts of the target at seven moments of each blend.
void write_ghosts(const BlendOptions& options, const Stage& stage, const std::vector<BlendStep>& steps) {
  constexpr size_t kGhosts = 7;
  const Target& target = stage.character->target;
  std::vector<render::GhostSeries> series;
  for (const BlendStep& step : steps) {
    render::GhostSeries& one = series.emplace_back();
    one.caption = step.clip.name;
    const auto& poses = step.clip.poses;
    const size_t ghosts = std::min(kGhosts * static_cast<size_t>(options.cycles), poses.size());
    for (size_t i = 0; i < ghosts; ++i) {
      const size_t t = ghosts == 1 ? 0 : i * (poses.size() - 1) / (ghosts - 1);
      Mesh& ghost = one.ghosts.emplace_back(target.mesh);
      ghost.vertices = stage.retargeter->performer().deformer()->deform(poses[t]);
      one.seconds.push_back(static_cast<double>(t) / step.clip.fps);
    }
  }
  render::GhostSheetOptions sheet;
  for (const std::string& part : options.parts) append_item(sheet.title, file_name(part), " - ");
  sheet.title += ", performed by " + file_name(options.target.path) + "; made, not captured";
  sheet.columns = static_cast<int>(std::min<size_t>(series.size(), 4));
  sheet.heading = heading_of_joints(steps[0].joints[0]);
  render::write_png(options.preview, render::ghost_sheet(series, sheet));
}

void tell(const BlendStep& step) {
  std::printf("%s: %.2f s, %zu frames, expected to be off by %.1f cm on average, feet slide %.2f m/s\n",
              step.clip.name.c_str(), static_cast<double>(step.source.seconds), step.clip.poses.size(),
              100 * mean_of(step.source.motion.doubt_m), foot_skate(step.joints, step.clip.fps));
}

ExportCost write_out(const BlendOptions& options, const Stage& stage, const std::vector<BlendStep>& steps) {
  ExportInput input{{stage.character, stage.retargeter->performer().deformer(), {}}, {}, {}};
  input.body.file.their_rig = stage.format->is_character && on_their_rig(options.target, *stage.character);
  input.body.file.joints = stage.character->target.joints;
  input.body.file.progress = [](float) { check_interrupt("during the export"); };
  input.name = clip_name(options.target.path);
  for (const BlendStep& step : steps) {
    input.clips.push_back(step.clip);
    input.source_joints.insert(input.source_joints.end(), step.source_joints.begin(),
                               step.source_joints.end());
  }
  return export_motion(options.out, *stage.format, {input});
}

int blend(const BlendOptions& options) {
  const ExportFormat& format = export_format("", options.out);
  const BlendRecipe recipe = recipe_of(options);
  std::vector<std::string> read = {options.target.path};
  for (const BlendPart& part : recipe.parts) read.push_back(part.path);
  for (const std::string& path : {options.out, options.report, options.preview}) check_not_read(path, read);
  check_export(options.out, format);
  const auto weights = weights_of(options);
  US_CHECK(weights.size() == 1 || format.is_character, options.out, ": ", format.label,
           " holds one motion, not ", weights.size(), " blends; --shares gives one");
  for (const std::string& path : {options.report, options.preview}) check_writable(path);
  MotionBlender blender(coder_loader(options.how.weights));
  BlendRecipe first = recipe;
  set_weights(weights.front(), first);
  const BlendedMotion made = blender.make(first, options.fps);  // or throws before a target is bound
  for (const std::string& note : made.notes) log::info(note);
  for (const std::string& warning : made.warnings) log::warn(warning);
  Stage stage = open_stage(options, format);
  std::vector<BlendStep> steps;
  for (const auto& one : weights) {
    steps.push_back(perform_step(options, recipe, one, stage, blender));
    tell(steps.back());
  }
  const ExportCost cost = write_out(options, stage, steps);
  std::printf("%s %lld bytes, %zu clips, all of them made\n", options.out.c_str(),
              static_cast<long long>(cost.bytes), steps.size());
  if (!options.report.empty()) write_json(options.report, report_of(options, recipe, steps));
  if (!options.preview.empty()) write_ghosts(options, stage, steps);
  return 0;
}

}  // namespace

Action declare_blend(CLI::App& command) {
  const auto options = std::make_shared<BlendOptions>();
  command
      .add_option("motions", options->parts,
                  "two to four skeletal motions (" + format_names(kMotion) +
                      "), or some frames of them, FILE@FIRST:LAST; of a whole file its best step is taken")
      ->required();
  command
      .add_option("--steps", options->steps,
                  "how many blends, evenly spread from the first motion to the last (default: 5)")
      ->check(CLI::Range(2, 100));
  command.add_option("--shares", options->shares, "one blend alone: 0.2,0.8 is mostly the second motion");
  command
      .add_option("--cycles", options->cycles,
                  "plays each movement so often, one after the other (default: 1)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--fps", options->fps, "frames/s (default: those of the first motion)")
      ->check(CLI::Range(1.0, 1000.0));
  command
      .add_option("--coder", options->coder,
                  "paper: a learned space of movements; plain: straight from pose to pose (default: paper)")
      ->check(CLI::IsMember({"paper", "plain"}));
  command
      .add_option("--target", options->target.path,
                  "a character in any upright pose, or an SMPL-format body: " + format_names(kTarget))
      ->required();
  add_target_options(command, options->target);
  add_method_options(command, options->how);
  command
      .add_option("--out", options->out, "the animated target, a clip for each blend: " + export_suffixes())
      ->required();
  command.add_option("--report", options->report,
                     "motions, weights, durations, doubt and sliding feet of each blend, as JSON");
  command.add_option("--preview", options->preview, "PNG of each blend as ghosts coloured by time");
  return [options] { return blend(*options); };
}

}  // namespace understudy::app
