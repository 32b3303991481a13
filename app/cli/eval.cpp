#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app/cli/commands.hpp"
#include "app/cli/evaluation.hpp"
#include "app/cli/options.hpp"
#include "app/cli/worst_frames.hpp"
#include "render/band_plot.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/metrics/metric_table.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

std::string one_line(const CaseResult& result) {
  if (!result.error.empty()) return result.name + ": ERROR " + result.error;
  std::string line = result.name + ": " + std::to_string(result.frames) + " frames";
  if (result.flagged > 0) line += ", " + std::to_string(result.flagged) + " flagged";
  for (const char* key : {"mpjpe_m",
                          "pa_mpjpe_m",
                          "pa_mpvd_m",
                          "medl_mm",
                          "file_medl_mm",
                          "extraction_mpjpe_mm",
                          "extraction_swap_rate",
                          "extraction_seen_mm",
                          "visibility_right",
                          "points_owner_right",
                          "identities_exchanged",
                          "people_missed",
                          "people_mm",
                          "people_alone_mm",
                          "hand_contact_kept",
                          "arm_buried_added",
                          "joint_recall",
                          "joint_precision",
                          "joint_error_pct",
                          "part_ri",
                          "tree_f1",
                          "track_pct",
                          "surface_held_out",
                          "retarget_pct",
                          "retarget_scan_pct",
                          "cd_1e4",
                          "m_cd_lerp",
                          "m_cd_slerp",
                          "m_cd_match",
                          "m_cd_vrnn",
                          "m_cd_positions",
                          "made_skate",
                          "made_skate_true",
                          "made_nearest_mm",
                          "made_nearest_training_mm",
                          "gap_mpjpe_m",
                          "chamfer_m",
                          "seam_m",
                          "spread",
                          "style_share",
                          "coordination_share",
                          "content_kept",
                          "real_style_share",
                          "dtw_deg",
                          "jerk_ratio"})
    for (const auto& [name, value] : result.metrics)
      if (name == key) line += printed(", %s %.4g", key, value);
  return line;
}

/// FOLDER/style_figures.png: the medians of a style's subjects over the range of the real ones.
void write_style_figures(const std::string& folder, const Json& summary) {
  const auto number = [](const Json& row, const char* key) {
    return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
  };
  std::vector<render::BandRow> rows;
  for (const auto& [key, row] : summary["medians"].items()) {
    const Metric& metric = *find_metric(key);
    rows.push_back({metric.label, metric.unit, metric.digits, number(row, "source"), number(row, "styled"),
                    number(row, "real_low"), number(row, "real"), number(row, "real_high")});
  }
  std::filesystem::create_directories(folder);
  render::write_png(folder + "/style_figures.png",
                    render::band_plot(rows, {"Medians over subjects", "as they are", "in the style",
                                             "who is wanted, with their median"}));
}

int eval(EvalOptions options, const std::string& out, const std::string& pictures) {
  check_writable(out);
  options.pictures = !pictures.empty();
  const Evaluation evaluation = evaluate(options, [](const CaseResult& result) {
    std::printf("%s\n", one_line(result).c_str());
    std::fflush(stdout);
  });
  if (!out.empty()) write_json(out, report_of(options, evaluation));
  if (!pictures.empty()) write_worst_frames(pictures, evaluation.breakdown.worst());
  if (!pictures.empty()) write_flat_pictures(pictures, evaluation.flat_moments);
  if (!pictures.empty() && !evaluation.style.is_null()) write_style_figures(pictures, evaluation.style);
  for (const auto& [kind, row] : evaluation.keypoints.items())
    std::printf("%s: sc %.3f of %d keypoints (%.1f not faint)\n", kind.c_str(), row["sc"].get<double>(),
                row["keypoints"].get<int>(), row["bright"].get<double>());
  std::printf("mean: %s\n", to_json(evaluation.mean).dump().c_str());
  return evaluation.failed ? 1 : 0;
}

struct EvalFiles {
  std::string out, pictures;
};

/// Of the suites of creatures.
void add_rig_options(CLI::App& command, EvalOptions& options) {
  command
      .add_option("--method", options.rig_method,
                  "how rigs are found (creatures). " + help_of(rig_methods()) +
                      " (default: " + rig_methods().front().name + ")")
      ->check([](const std::string& name) { return failure_of([&] { rig_method_named(name); }); });
  command.add_flag("--held-out", options.held_out,
                   "finds rigs once more, in even frames alone, and poses them on the odd ones (creatures)");
}

}  // namespace

Action declare_eval(CLI::App& command) {
  const auto options = std::make_shared<EvalOptions>();
  const auto files = std::make_shared<EvalFiles>();
  command.add_option("cases", options->cases, "a folder of cases, or one case")->required();
  command.add_option("--out", files->out, "report as JSON");
  command
      .add_option("--oracle", options->oracle,
                  "skeleton: true source joints; pose: true rotations, root, target joints")
      ->check(CLI::IsMember({"skeleton", "pose"}));
  command.add_option("--filter", options->filter, "only cases whose name contains this");
  command.add_option("--limit", options->limit, "at most this many cases, evenly spread")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--restart-every", options->restart_every,
                  "resets the method every so many frames: contexts of this length")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option(
          "--baseline", options->baseline,
          "fit: fit a body to each scan instead of extracting a skeleton; complete: fit one body to all "
          "known frames of a case at once, as --complete does (sparse); nodes: follow far-apart points of "
          "the "
          "first frame instead of finding a rig (creatures); adain, action: a clip's own mean and spread, or "
          "those of its action, become those of the wanted manner (style)")
      ->check(CLI::IsMember({"fit", "complete", "nodes", "adain", "action"}));
  command
      .add_option("--file", options->file_shapes,
                  "evaluates the exported GLB, too, with this many morph targets: file_medl_mm, ...")
      ->check(CLI::Range(0, 64));
  command.add_option("--body", options->body, "the SMPL-format body that the baseline fits");
  command
      .add_option("--fill", options->fill,
                  "what makes the frames in a case's gaps. " + motion_space_help() +
                      " (default: " + kDefaultMotionSpace + ")")
      ->check([](const std::string& name) { return failure_of([&] { motion_space_named(name); }); });
  command.add_option(
      "--data", options->data,
      "the folder of people and motions that --fill nearest looks into, and in which the motion nearest to a "
      "made one is looked for (marionette-gaps); the folder with the clips of both manners, for the "
      "baselines of style");
  command.add_option("--judge", options->judge, "weights of `train style-judge` (style)");
  command.add_option("--style-back", options->style_back,
                     "a style that takes back what --style does: there and back again (style)");
  add_tempo_options(command, options->tempo);
  command.add_option("--legs", options->legs_m, "for --tempo body: legs of who performs it, metres (style)")
      ->check(CLI::Range(0.01, 100.0));
  add_rig_options(command, *options);
  command.add_option("--worst", options->worst, "worst frames to list (default: 20)")
      ->check(CLI::Range(0, 10000));
  command.add_option("--pictures", files->pictures,
                     "folder for pictures of the worst frames; of a style's figures over those of real "
                     "clips; of moments of 2D "
                     "poses by every engine");
  add_scan_options(command, options->edits);
  add_method_options(command, options->how);
  return [options, files] { return eval(*options, files->out, files->pictures); };
}

}  // namespace understudy::app
