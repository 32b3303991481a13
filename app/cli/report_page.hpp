// The page of a comparison: tables in Markdown and plots.
#pragma once

#include <string>
#include <vector>

#include "app/cli/report_rows.hpp"

namespace understudy::app {

/// A row with its figures, or why there are none.
struct ReportResult {
  ReportRow row;
  Json report;       ///< as eval writes it
  std::string lost;  ///< why the row is left out; empty: it is not
};

/// Writes FOLDER/report.md and its plots. `command`: how the page was made; `note`: what else its head says.
void write_report_page(const std::string& folder, const std::vector<ReportResult>& results,
                       const std::string& command, const std::string& note);

}  // namespace understudy::app
