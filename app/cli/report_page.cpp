#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "app/cli/report.hpp"
#include "app/run/breakdown.hpp"
#include "render/plot.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/metrics/metric_table.hpp"

namespace understudy::app {
namespace {

/// A figure of a table: where it is in a report, and how it is printed.
struct Column {
  const char *group, *key;
  const char* title = nullptr;  ///< null: the key
  double scale = 1;             ///< of a share: 100, in per cent
  int digits = -1;              ///< -1: those of the metric
};

struct Table {
  const char *id, *title, *text;
  std::vector<Column> columns;
};

const std::vector<Column> kPerformance = {{"mean", "mpjpe_m"},   {"mean", "pa_mpjpe_m"},
                                          {"mean", "pa_mpvd_m"}, {"mean", "medl_mm"},
                                          {"mean", "acc"},       {"mean", "pa_acc"},
                                          {"mean", "rot_deg"},   {"ms", "total", "s a frame", 0.001, 3}};

/// Of hands, feet and skin.
const std::vector<Column> kContacts = {{"mean", "foot_skate", "feet slide, m/s"},
                                       {"mean", "floor_mm", "floor, mm"},
                                       {"mean", "floor_worst_mm", "worst, mm"},
                                       {"mean", "hand_contact_kept", "hand contacts, %", 100, 0},
                                       {"mean", "hand_contact_gap_mm", "gap, mm"},
                                       {"mean", "arm_buried_added", "arms buried, %", 100, 2},
                                       {"mean", "self_penetration", "skin buried, %", 100, 2},
                                       {"mean", "hand_stretch", "hands stretch, %", 100, 2},
                                       {"mean", "hand_stretch_true", "true, %", 100, 2},
                                       {"mean", "head_stretch", "head stretches, %", 100, 2},
                                       {"mean", "head_stretch_true", "true, %", 100, 2}};
const std::vector<Column> kExtraction = {{"mean", "extraction_mpjpe_mm", "mm"},
                                         {"mean", "extraction_raw_mpjpe_mm", "raw, mm"},
                                         {"mean", "extraction_swap_rate", "swapped, %", 100, 2},
                                         {"mean", "extraction_flip_rate", "flipped, %", 100, 2},
                                         {"mean", "inside", "inside, %", 100, 1},
                                         {"ms", "extract", "ms a frame", 1, 1}};
const std::vector<Column> kOffsets = {{"mean", "mpvd_m", nullptr, 1, 5},
                                      {"mean", "pa_mpvd_m", nullptr, 1, 5},
                                      {"mean", "medl_mm"},
                                      {"mean", "bent_volume", "volume, %", 100, 1},
                                      {"mean", "bent_volume_true", "true, %", 100, 1}};
const std::vector<Column> kRotations = {{"mean", "rot_deg"},
                                        {"mean", "head_deg"},
                                        {"mean", "wrist_deg"},
                                        {"mean", "foot_deg"},
                                        {"mean", "pa_mpjpe_m"}};
const std::vector<Column> kAligned = {{"mean", "pa_mpjpe_m"},
                                      {"mean", "pa_mpvd_m"},
                                      {"mean", "medl_mm"},
                                      {"mean", "pa_acc"},
                                      {"mean", "rot_deg"}};

const std::vector<Column> kInbetween = {{"mean", "gap_mpjpe_m", "mpjpe, mm", 1000, 1},
                                        {"mean", "gap_rel_mpjpe_m", "less pelvis, mm", 1000, 1},
                                        {"mean", "mve_m", "vertices, mm", 1000, 1},
                                        {"mean", "gap_foot_skate", "feet slide, m/s", 1, 2},
                                        {"mean", "gap_foot_skate_true", "true, m/s", 1, 2},
                                        {"mean", "gap_acc", "acc", 1, 4},
                                        {"mean", "seam_m", "seam, mm", 1000, 2},
                                        {"mean", "spread"},
                                        {"ms", "total", "ms a window", 1, 1}};

const std::vector<Column> kPredict = {{"mean", "mve_3_m", "3 frames on, mm", 1000, 0},
                                      {"mean", "mve_8_m", "8, mm", 1000, 0},
                                      {"mean", "mve_15_m", "15, mm", 1000, 0},
                                      {"mean", "gap_mpjpe_m", "mpjpe of all, mm", 1000, 1},
                                      {"mean", "gap_rel_mpjpe_m", "less pelvis, mm", 1000, 1},
                                      {"mean", "gap_foot_skate", "feet slide, m/s", 1, 2},
                                      {"mean", "gap_foot_skate_true", "true, m/s", 1, 2},
                                      {"mean", "spread"},
                                      {"ms", "total", "ms a window", 1, 1}};

const std::vector<Column> kSparse = {{"mean", "mve_m", "vertices, mm", 1000, 1},
                                     {"mean", "gap_mpjpe_m", "mpjpe, mm", 1000, 1},
                                     {"mean", "gap_rel_mpjpe_m", "less pelvis, mm", 1000, 1},
                                     {"mean", "chamfer_m", "chamfer, mm", 1000, 1},
                                     {"mean", "gap_foot_skate", "feet slide, m/s", 1, 2},
                                     {"mean", "gap_foot_skate_true", "true, m/s", 1, 2},
                                     {"mean", "spread"}};

const std::vector<Table>& tables() {
  static const std::vector<Table> all = {
      {"baselines", "Against baselines",
       "`copy` and `paper` are the program's engines. `fit`: a parametric body is fitted to each scan by "
       "optimisation from the scans alone, and its rotations are copied; where the people evaluated on are "
       "of that very body, as in suites made from one data folder, it knows them better than it would know "
       "strangers.",
       kPerformance},
      {"baselines", "Contacts, penetration, and what has no joints of its own",
       "Of the same rows. Floor: how deep the lowest vertex lies below it, mean and worst. Hand contacts: of "
       "those of the source's own surface (a hand within 2 cm of the body) how many the target keeps. Arms, "
       "hands and skin buried: shares inside the rest of the target's own body, of arms and hands less the "
       "source's. Stretch: change of edges' lengths beyond the wrists and above the head's joint, and the "
       "truth's.",
       kContacts},
      {"seen", "Rotations seen on the surface",
       "Positions alone do not determine how a bone is twisted, nor how head, hands and feet are turned.",
       kRotations},
      {"contexts", "Contexts",
       "The method forgets the past after so many frames; each network of `paper` was trained on sequences "
       "of that length. Positions restart, so only figures after alignment are compared.",
       kAligned},
      {"rotation", "Rotation forms of the network, with and without a rotation loss",
       "All trained with the same budget, shorter than that of the shipped weights.", kPerformance},
      {"extraction", "Skeleton extraction",
       "Of the source's 22 joints, repaired and smoothed; raw: as extracted.", kExtraction},
      {"offsets", "Pose-corrective offsets",
       "With true poses weights and offsets alone are evaluated. Without: the same network, its offsets left "
       "out. Volume: what flesh about elbows, knees, shoulders and hips keeps of its volume where they are "
       "turned by more than 90 degrees, and what it should.",
       kOffsets},
      {"inbetween", "Frames in gaps",
       "Of the frames that were not known alone, in the world, over all gaps alike. `hold`: the last known "
       "pose stays; `slerp`: shortest turns between the ends; `hermite`: curves that keep the speed at both "
       "ends; `nearest`: the most similar stretch of the training clips, bent through both ends. Seam: "
       "second "
       "differences against the true ones, two frames at each end. Spread: rank correlation of the doubt "
       "told "
       "with each frame and its error.",
       kInbetween},
      {"predict", "Frames to come",
       "The first eight frames of a window are known and none after them; errors of vertices in the world, "
       "at the 3rd, 8th and 15th frame that was predicted. `glide`: the last known pose stays, and the body "
       "goes on as fast as it went; `coast`: every joint goes on, too; `hermite`: all comes to rest.",
       kPredict},
      {"sparse", "Few frames, few points",
       "Steps of 100 frames, however long they take, of which 2, 5 or 20 are known; errors of the others "
       "alone, in the world. With true poses in the known frames, on the mean body; or from scans of few "
       "points, drawn anew in each known frame, on the person scanned. Chamfer: half the sum of the mean "
       "distances from each vertex of the made surface to the nearest true one and back, of all 100 frames.",
       kSparse}};
  return all;
}

std::string figure(const Json& report, const Column& column) {
  if (!report.contains(column.group) || !report[column.group].contains(column.key)) return "";
  const Metric* const metric = find_metric(column.key);
  return printed("%.*f", column.digits >= 0 || !metric ? column.digits : metric->digits,
                 column.scale * report[column.group][column.key].get<double>());
}

std::string name_of(const ReportRow& row) {
  const int context = row.eval.restart_every;
  return row.name + (context > 0 ? ", " + std::to_string(context) + " frames" : "");
}

void write_line(std::ostream& page, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) page << "| " << cell << ' ';
  page << "|\n";
}

void write_head(std::ostream& page, const std::vector<std::string>& cells) {
  write_line(page, cells);
  for (size_t i = 0; i < cells.size(); ++i) page << "|---";
  page << "|\n";
}

/// `tell_lost`: also the rows that have no figures.
void write_table(std::ostream& page, const Table& table, const std::vector<ReportResult>& results,
                 bool tell_lost) {
  bool begun = false;
  std::string lost;
  for (const ReportResult& result : results) {
    if (result.row.table != table.id) continue;
    if (!result.lost.empty()) {
      if (tell_lost)
        lost += "- left out: " + name_of(result.row) + ", " + result.row.suite + ": " + result.lost + "\n";
      continue;
    }
    if (!begun) {
      page << "\n## " << table.title << "\n\n" << table.text << "\n\n";
      std::vector<std::string> head = {"suite", "row"};
      for (const Column& column : table.columns) head.push_back(column.title ? column.title : column.key);
      head.insert(head.end(), {"cases", "trained with"});
      write_head(page, head);
      begun = true;
    }
    std::vector<std::string> cells = {result.row.suite, name_of(result.row)};
    for (const Column& column : table.columns) cells.push_back(figure(result.report, column));
    cells.push_back(std::to_string(result.report["cases"].size()));
    cells.push_back(result.row.budget);
    write_line(page, cells);
  }
  if (!begun && !lost.empty()) page << "\n## " << table.title << "\n";
  if (!lost.empty()) page << '\n' << lost;
}

/// One curve an engine over the contexts, when there are two or more.
void plot_contexts(std::ostream& page, const std::string& folder, const std::vector<ReportResult>& results) {
  std::map<std::string, render::Curve> curves;
  for (const ReportResult& result : results)
    if (result.row.table == "contexts" && result.lost.empty() &&
        result.report["mean"].contains("pa_mpjpe_m")) {
      render::Curve& curve = curves[result.row.name];
      curve.name = result.row.name;
      curve.x.push_back(result.row.eval.restart_every);
      curve.y.push_back(1000 * result.report["mean"]["pa_mpjpe_m"].get<double>());
    }
  std::vector<render::Curve> all;
  for (auto& [name, curve] : curves)
    if (curve.x.size() > 1) all.push_back(std::move(curve));
  if (all.empty()) return;
  render::write_png(folder + "/contexts.png",
                    render::plot(all, {"Error over the length of the context", "frames", "pa_mpjpe, mm"}));
  page << "\n![Error over the length of the context](contexts.png)\n";
}

/// NaN where there is no such number.
double number_of(const Json& json, const char* key) {
  return json[key].is_number() ? json[key].get<double>() : std::nan("");
}

void write_confidence(std::ostream& page, const std::string& folder, const std::string& suite,
                      const Json& confidence) {
  page << printed(
      "\nConfidence against error, rank correlation: %.2f over joints (errors drawn from exactly what "
      "it expects: %.2f), %.2f over frames.\n\n",
      number_of(confidence, "rank_correlation"), number_of(confidence, "best_rank_correlation"),
      number_of(confidence, "frame_rank_correlation"));
  render::Curve mean{"mean error", {}, {}}, p90{"90 % stay below", {}, {}}, expected{"expected", {}, {}};
  write_head(page, {"confidence", "expected, mm", "mean error, mm", "90 % below, mm", "joints"});
  for (const Json& bin : confidence["bins"]) {
    for (auto& [curve, key] : {std::pair(&expected, "expected_mm"), {&mean, "error_mm"}, {&p90, "p90_mm"}}) {
      curve->x.push_back(bin["confidence"]);
      curve->y.push_back(bin[key]);
    }
    page << printed("| %.3f | %.1f | %.1f | %.1f | %lld |\n", bin["confidence"].get<double>(),
                    bin["expected_mm"].get<double>(), bin["error_mm"].get<double>(),
                    bin["p90_mm"].get<double>(), bin["count"].get<long long>());
  }
  const std::string file = "confidence_" + suite + ".png";
  render::write_png(
      folder + "/" + file,
      render::plot({expected, mean, p90}, {"Confidence and error: " + suite, "confidence", "mm"}));
  page << "\n![Confidence and error](" << file << ")\n";
}

/// Figures by name: joints, motions, bodies.
void write_groups(std::ostream& page, const char* what, const Json& groups,
                  const std::vector<Column>& columns) {
  if (groups.empty()) return;
  std::vector<std::string> head = {what};
  for (const Column& column : columns) head.push_back(column.title ? column.title : column.key);
  page << '\n';
  write_head(page, head);
  for (const auto& group : groups.items()) {
    std::vector<std::string> cells = {group.key()};
    for (const Column& column : columns) cells.push_back(figure({{"", group.value()}}, column));
    write_line(page, cells);
  }
}

void write_breakdown(std::ostream& page, const std::string& folder, const ReportResult& result) {
  const Json& breakdown = result.report["breakdown"];
  page << "\n## " << result.row.suite << ", `" << result.row.name << "`: where the error lies\n";
  write_groups(page, "joint", breakdown["joints"],
               {{"", "extraction_mm", "extraction, mm", 1, 1},
                {"", "pa_mpjpe_mm", "pa_mpjpe, mm", 1, 1},
                {"", "rot_deg"}});
  const std::vector<Column> grouped = {
      {"", "extraction_mpjpe_mm", "extraction, mm"}, {"", "pa_mpjpe_m"}, {"", "rot_deg"}, {"", "acc"}};
  write_groups(page, "motion", breakdown["motions"], grouped);
  write_groups(page, "body", breakdown["bodies"], grouped);
  page << '\n';
  write_head(page, {"failure", "frames", "share, %"});
  for (const auto& failure : breakdown["failures"].items()) {
    if (failure.value()["evaluated"] == 0) continue;
    page << printed("| %s | %lld | %.2f |\n", failure.key().c_str(),
                    failure.value()["frames"].get<long long>(), 100 * failure.value()["share"].get<double>());
  }
  if (breakdown.contains("confidence"))
    write_confidence(page, folder, result.row.suite, breakdown["confidence"]);
  if (!breakdown["worst"].empty())
    page << "\nThe frames seen worst, beside what is true (green):\n\n![The frames seen worst](worst_"
         << result.row.suite << ".png)\n";
}

/// Whoever looks at a scan does not know of which suite it is.
void write_confidence_of_all(std::ostream& page, const std::string& folder,
                             const std::vector<ReportResult>& results) {
  ConfidenceRecord all;
  std::string suites;
  std::vector<Json> counted;  // suites may share their scans
  for (const ReportResult& result : results) {
    if (!result.lost.empty() || !result.report.contains("confidence_record")) continue;
    const Json& record = result.report["confidence_record"];
    if (std::find(counted.begin(), counted.end(), record) != counted.end()) continue;
    counted.push_back(record);
    all.append(confidence_record(record));
    append_item(suites, result.row.suite);
  }
  if (all.confidence.empty()) return;
  page << "\n## Confidence in all of these together: " << suites << "\n";
  write_confidence(page, folder, "all", all.figures());
}

}  // namespace

void write_report_page(const std::string& folder, const std::vector<ReportResult>& results,
                       const std::string& command, const std::string& note) {
  std::ostringstream page;
  page << "# Comparison\n\nMade by `" << command
       << "`.\nTruth copies rotations between bodies of one family, so figures of other protocols do not "
          "compare.\n"
       << note;
  std::string before;  // two tables may be of the same rows
  for (const Table& table : tables()) {
    write_table(page, table, results, before != table.id);
    before = table.id;
    if (std::string(table.id) == "contexts") plot_contexts(page, folder, results);
  }
  for (const ReportResult& result : results)
    if (result.lost.empty() && result.row.breakdown) write_breakdown(page, folder, result);
  write_confidence_of_all(page, folder, results);
  write_file(folder + "/report.md", page.str());
}

}  // namespace understudy::app
