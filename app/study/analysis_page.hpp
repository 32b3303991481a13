// The report of a study for people: one page with box plots and tables.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/study/analysis.hpp"

namespace understudy::app {

/// A box for each level as an SVG picture: quartiles, median, Tukey's whiskers, a ring for answers beyond.
/// `effect` has summaries.
std::string box_plot(const std::string& title, const EffectReport& effect);

/// Files of a folder and their text: index.html, which needs no other file, the box plots as boxes_*.svg, and
/// csv_tables().
std::vector<std::pair<std::string, std::string>> page_files(const StudyReport& report);
/// Writes them, and makes the folder where there is none. Throws Error naming what cannot be written.
void write_page(const std::string& folder, const StudyReport& report);

}  // namespace understudy::app
