#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/progress.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/styled_clip.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/rig/person_rig.hpp"
#include "retarget/style/load_style.hpp"

namespace understudy::app {
namespace {

struct StyleOptions {
  SourceOptions source;
  MethodOptions how;
  TempoChoice tempo;
  double legs_m = 0;  ///< of who is to perform it; 0: not told
  std::string out, report;
  bool list = false;
};

StyledClip clip_of(const StyleOptions& options) {
  NetworkParts parts;
  parts.extractor = parts.style = true;
  std::optional<Progress> progress;
  return styled_clip(options.source, nn::load_networks(network_options(options.how), parts),
                     retarget_options(options.how), source_tools(options.how), [&](int64_t done, int64_t of) {
                       check_interrupt("after frame " + std::to_string(done));
                       if (!progress) progress.emplace(file_name(options.source.path), of);
                       progress->step(done);
                     });
}

/// An octahedron along each bone.
void add_bone_shapes(const Joints& rest, understudy::Rig& rig) {
  std::vector<int> owners;
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> corners;
  for (int j = 1; j < kJointCount; ++j) {
    const Vec3 from = rest.row(kParents[j]).transpose(), to = rest.row(j).transpose(), way = to - from;
    if (way.norm() < 1e-4f) continue;
    const Vec3 side = way.unitOrthogonal() * 0.1f * way.norm(), other = way.normalized().cross(side);
    const int first = static_cast<int>(points.size());
    const Vec3 ring = from + 0.2f * way;
    for (const Vec3& point :
         {from, to, Vec3(ring + side), Vec3(ring + other), Vec3(ring - side), Vec3(ring - other)})
      points.push_back(point), owners.push_back(kParents[j]);
    for (int i = 0; i < 4; ++i) {
      const int a = first + 2 + i, b = first + 2 + (i + 1) % 4;
      corners.push_back({first, b, a}), corners.push_back({first + 1, a, b});
    }
  }
  rig.surface.vertices.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (size_t i = 0; i < points.size(); ++i)
    rig.surface.vertices.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  rig.surface.faces.resize(static_cast<Eigen::Index>(corners.size()), 3);
  for (size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < 3; ++k)
      rig.surface.faces(static_cast<Eigen::Index>(i), k) = corners[i][static_cast<size_t>(k)];
  rig.skin = SkinWeights::rigid(owners);
}

RiggedMotion rigged(const StyledClip& clip, const std::string& name) {
  RiggedMotion performed{person_rig(clip.rest), {}};
  performed.rig.name = name;
  add_bone_shapes(clip.rest, performed.rig);
  performed.motion.fps = clip.fps;
  for (const Pose& pose : clip.poses) performed.motion.poses.push_back(person_pose(pose));
  return performed;
}

void write_clip(const std::string& path, const StyledClip& clip, const std::string& rights) {
  const std::string suffix = file_suffix(path);
  if (suffix == ".glb") {
    Character character = to_character(rigged(clip, file_name(path)));
    character.rights = rights;
    return write_gltf_character(path, character);
  }
  tell_left_out(path, rights);
  if (suffix == ".bvh") {
    BvhWriter out(path, clip.rest, clip.fps);
    for (const Pose& pose : clip.poses) out.push(pose);
    return out.finish();
  }
  AmassWriter out(path, clip.fps);
  for (const Pose& pose : clip.poses) out.push(pose);
  out.finish();
}

int list_styles() {
  for (const MannerFile& style : bundled_styles()) {
    const StyleNote& note = style.note;
    std::printf("%-10s manner  %s. Made from: %s. Licence: %s%s%s\n", note.name.c_str(),
                note.sentence.c_str(), note.made_from.c_str(), note.licence.c_str(),
                note.non_commercial() ? " (non-commercial)" : "",
                note.attribution.empty() ? "" : (", " + note.attribution).c_str());
  }
  return 0;
}

/// Null where either is not known.
Json ratio(double after, double before) {
  return std::isfinite(after) && std::isfinite(before) && before != 0 ? Json(after / before) : Json();
}

/// The figures of the source on its own bones, and those of what was made of it.
void write_report(const StyleOptions& options, const StyledClip& styled, const Metrics& before_tempo) {
  StyleOptions plain = options;
  plain.how.method.style = {};
  const StyledClip source = clip_of(plain);
  const Metrics is = figures_of(styled), was = figures_of(source);
  Json report = {{"source", options.source.path}, {"style", style_json(options.how.method.style)},
                 {"frames", styled.poses.size()}, {"apart_m", styled.apart_m},
                 {"path_m", styled.path_m},       {"source_figures", to_json(was)},
                 {"figures", to_json(is)}};
  report["jerk_ratio"] = ratio(value_of(before_tempo, "jerk"), value_of(was, "jerk"));
  report["stance_slide_ratio"] = ratio(value_of(is, "stance_slide"), value_of(was, "stance_slide"));
  report["cycle_ratio"] = ratio(value_of(is, "cycle_s"), value_of(was, "cycle_s"));
  write_json(options.report, report);
}

int run_style(const StyleOptions& options) {
  if (options.list) return list_styles();
  US_CHECK(!options.source.path.empty(), "MOTION is required: what is to be styled, or --list");
  US_CHECK(options.how.method.style.any() || options.tempo.any(), "--to is required: the style, or --tempo");
  US_CHECK(!options.out.empty(), "--out is required: the file to write");
  const std::string suffix = file_suffix(options.out);
  US_CHECK(suffix == ".bvh" || suffix == ".npz" || suffix == ".glb", options.out,
           ": a styled motion is written as .bvh, .npz or .glb");
  check(options.tempo);
  check_not_read(options.out, {options.source.path, options.source.motion, options.source.times});
  for (const std::string& path : {options.out, options.report}) check_writable(path);
  StyledClip clip = clip_of(options);
  const double before_s = static_cast<double>(clip.poses.size()) / clip.fps;
  const Metrics before_tempo = options.report.empty() ? Metrics() : figures_of(clip);
  give_tempo(options.tempo, options.legs_m, clip);
  write_clip(options.out, clip, style_rights(options.how.method.style));
  if (!options.report.empty()) write_report(options, clip, before_tempo);
  std::printf(
      "%s: %zu frames, %.2f s (%.2f s of the source); it ends %.0f cm from where the source does, whose path "
      "is %.2f m\n",
      options.out.c_str(), clip.poses.size(), static_cast<double>(clip.poses.size()) / clip.fps, before_s,
      static_cast<double>(100 * clip.apart_m), static_cast<double>(clip.path_m));
  return 0;
}

}  // namespace

Action declare_style(CLI::App& command) {
  const auto options = std::make_shared<StyleOptions>();
  command.add_option("MOTION", options->source.path,
                     "a skeletal motion (" + format_names(kMotion) + "), or scans as `retarget` takes them");
  add_source_options(command, options->source);
  command.add_option_function<std::string>(
      "--to,--style", [options](const std::string& word) { options->how.method.style.choose(word); },
      "a style that comes with the program, or a style's file");
  command
      .add_option("--strength,--style-strength", options->how.method.style.strength,
                  "0: the source as it is, 1: the style, up to 1.5")
      ->check(CLI::Range(kStyleStrengths.low, kStyleStrengths.high));
  add_tempo_options(command, options->tempo);
  command
      .add_option("--legs", options->legs_m,
                  "for --tempo body: length of the legs of who performs it, metres")
      ->check(CLI::Range(0.01, 100.0));
  command.add_option("--weights", options->how.weights,
                     "folder of the weights (default: beside the program)");
  command.add_option("--out", options->out, "the styled motion: .bvh, .npz (AMASS) or .glb");
  command.add_option("--report", options->report, "how the source moves and how the result does, as JSON");
  command.add_flag("--list", options->list,
                   "prints the styles: what each does, what it was made from, its licence");
  return [options] { return run_style(*options); };
}

}  // namespace understudy::app
