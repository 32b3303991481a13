#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "app/cli/commands.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/rig_moment.hpp"
#include "app/run/exports.hpp"
#include "app/run/fields_json.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/motion_generator.hpp"
#include "app/run/rig_performance.hpp"
#include "render/contact_sheet.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {
namespace {

struct GenerateOptions {
  std::string rig, out, report, preview, weights, sampling = "aimed";
  std::vector<int> between;  // two, or none
  GenerationOptions how;
};

std::string engine_help() {
  std::string help;
  for (const GenerationEngine& engine : generation_engines())
    help += (help.empty() ? "" : "; ") + std::string(engine.name) + ": " + engine.sentence;
  return help + " (default: " + generation_engines()[0].name + ")";
}

std::vector<RigClip> clips_of(const GeneratedMotions& made) {
  std::vector<RigClip> clips;
  for (const GeneratedMotion& one : made.motions)
    clips.push_back({"motion " + std::to_string(one.seed), one.motion});
  return clips;
}

Json report_of(const GenerateOptions& options, const GeneratedMotions& made) {
  Json report = {{"rig", options.rig}, {"engine", options.how.engine}, {"motions", Json::array()}};
  for (const GeneratedMotion& one : made.motions)
    report["motions"].push_back({{"seed", one.seed},
                                 {"frames", one.motion.poses.size()},
                                 {"fps", one.motion.fps},
                                 {"nearest_m", one.nearest_m}});
  if (!made.remark.empty()) report["remark"] = made.remark;
  return report;
}

/// Moments of the first motion.
void write_sheet(const GenerateOptions& options, const understudy::Rig& rig, const RigMotion& motion) {
  constexpr int kShown = 6;
  const int last = static_cast<int>(ssize(motion.poses)) - 1, shown = std::min(kShown, last + 1);
  std::vector<render::SheetMoment> moments;
  moments.reserve(static_cast<size_t>(shown));
  for (int i = 0; i < shown; ++i)
    moments.push_back(rig_moment({rig, motion}, i * last / std::max(1, shown - 1)));
  render::SheetOptions sheet;
  sheet.title = file_name(options.rig) + ": " + std::to_string(last + 1) + " frames made";
  sheet.source_caption = "Skeleton";
  sheet.target_caption = "Rig, painted by bone";
  sheet.strays = false;
  render::write_png(options.preview, render::contact_sheet(moments, sheet));
}

void check_outputs(const GenerateOptions& options) {
  check_rig_path(options.out);
  US_CHECK(options.how.count <= 1 || is_rig_file(options.out), options.out,
           ": several motions are clips of one .glb or .gltf");
  for (const std::string& path : {options.out, options.report, options.preview}) {
    check_not_read(path, {options.rig});
    check_writable(path);
  }
}

int generate(GenerateOptions options) {
  if (!options.between.empty()) options.how.between = {options.between[0], options.between[1]};
  options.how.paper_sampling = options.sampling == "paper";
  US_CHECK(!options.how.paper_sampling || (options.how.engine == "vrnn" && options.how.between),
           "--sampling paper is of --engine vrnn with --between");
  check_outputs(options);
  RiggedMotion known = read_rig(options.rig);
  const std::string own_name = std::exchange(known.rig.name, file_name(options.rig));
  check_generation(known, options.how);
  Progress progress("making motions", options.how.count, false, "motion");
  nn::NetworkOptions networks;
  networks.weights = options.weights;
  const auto load = [&](const understudy::Rig& rig) {
    return nn::load_motion_dynamics(nn::weights_folder(networks), rig);
  };
  const GeneratedMotions made = generate_motions(known, options.how, load, [&](int done) {
    check_interrupt("nothing was written");
    progress.step(done);
    return true;
  });
  check_interrupt("nothing was written");
  progress.finish();
  if (!made.remark.empty()) log::warn(options.rig + ": " + made.remark);
  known.rig.name = own_name;
  write_rig(options.out, known.rig, clips_of(made));
  if (!options.report.empty()) write_json(options.report, report_of(options, made));
  if (!options.preview.empty()) write_sheet(options, known.rig, made.motions.front().motion);
  for (const GeneratedMotion& one : made.motions)
    std::printf("motion %llu: %zu frames, the clip's most alike piece is %.1f mm off\n",
                static_cast<unsigned long long>(one.seed), one.motion.poses.size(), 1000 * one.nearest_m);
  return 0;
}

}  // namespace

Action declare_generate(CLI::App& command) {
  const auto options = std::make_shared<GenerateOptions>();
  GenerationOptions& how = options->how;
  command
      .add_option("--rig", options->rig,
                  "a rigged character with a clip (.glb, .gltf), as `discover` writes it")
      ->required();
  command
      .add_option("--out", options->out,
                  "the same character with the new clips, as .glb or .gltf; one motion alone as .bvh")
      ->required();
  command.add_option("--frames", how.frames, "of each new clip, at the rate of the old one (default: 90)");
  const auto between = command.add_option(
      "--between", options->between,
      "two frames of the clip, from 0: the new one begins with the first pose and ends with the second");
  between->expected(2);
  command.add_flag("--loop", how.loop, "the new clip ends in the pose that it begins with")
      ->excludes(between);
  command.add_option("--seed", how.seed, "another one gives another motion (default: 1)")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--count", how.count, "so many motions, each with a seed of its own (default: 1)");
  command.add_option("--engine", how.engine, engine_help());
  command
      .add_option(
          "--sampling", options->sampling,
          "of vrnn with --between: aimed, it knows the pose to come (default); paper, the best of many")
      ->check(CLI::IsMember({"aimed", "paper"}));
  command.add_option("--weights", options->weights,
                     "folder of the weights, or one file of vrnn's (default: the program's own)");
  command.add_option("--report", options->report, "seeds, and how far from a copy each motion is, as JSON");
  command.add_option("--preview", options->preview, "contact sheet of the first motion as PNG");
  return [options] { return generate(*options); };
}

}  // namespace understudy::app
