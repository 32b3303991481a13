// A comparison of ways to do the job: its rows, and the page of tables in Markdown and plots.
#pragma once

#include <string>
#include <vector>

#include "app/cli/evaluation.hpp"

namespace understudy::app {

struct ReportRow {
  std::string
      table;  ///< baselines, seen, contexts, rotation, extraction, offsets, inbetween, predict or sparse
  std::string name;        ///< of the row
  std::string suite;       ///< folder of cases
  std::string budget;      ///< what its networks were trained with, in words
  bool breakdown = false;  ///< the page also breaks down its error and shows its worst frames
  EvalOptions eval;        ///< its cases are not named yet
};

struct ReportPlan {
  std::string note;  ///< for the page's head
  std::vector<ReportRow> rows;
};

/// {"note", "rows": [{"table", "name", "suite", "budget", "engine", "extractor", "weights", "engine_weights",
/// "extractor_weights", "offsets", "oracle", "baseline", "fill", "context", "limit", "breakdown", and
/// kSwitches by their names, now or before}]}; all but a row's first three may be missing. "context": frames
/// after which the past is forgotten. Paths are from the file's folder.
/// Throws Error naming the file and what it does not know.
ReportPlan read_report_plan(const std::string& path);

/// A row with its figures, or why there are none.
struct ReportResult {
  ReportRow row;
  Json report;       ///< as eval writes it
  std::string lost;  ///< why the row is left out; empty: it is not
};

/// Writes FOLDER/report.md and its plots. `command`: how the page was made; `note`: more text for its head.
void write_report_page(const std::string& folder, const std::vector<ReportResult>& results,
                       const std::string& command, const std::string& note);

}  // namespace understudy::app
