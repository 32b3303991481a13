#include "app/study/analysis_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr double kLeft = 56, kTop = 40, kHeight = 240, kLeastStep = 96, kLetter = 7.4, kBox = 44;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// From values to the height in the picture.
struct ValueAxis {
  double low = 0, high = 1, step = 1;
  double y(double value) const { return kTop + kHeight * (high - value) / (high - low); }
};

ValueAxis axis_of(const std::vector<LevelSummary>& boxes) {
  ValueAxis axis{boxes[0].least, boxes[0].most, 1};
  for (const LevelSummary& one : boxes) {
    axis.low = std::min(axis.low, one.least);
    axis.high = std::max(axis.high, one.most);
  }
  if (axis.high - axis.low <= 1) axis.step = 0.25;
  while ((axis.high - axis.low) / axis.step > 10) axis.step *= axis.step == 1 || axis.step == 10 ? 5 : 2;
  axis.low = std::floor(axis.low / axis.step) * axis.step;
  axis.high = std::max(std::ceil(axis.high / axis.step), axis.low / axis.step + 1) * axis.step;
  return axis;
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return printed("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1, y1, x2, y2, style);
}

std::string box(const LevelSummary& one, double x, const ValueAxis& axis) {
  constexpr const char *kThin = "stroke=\"#334\"", *kBold = "stroke=\"#112\" stroke-width=\"3\"";
  const double left = x - kBox / 2, right = x + kBox / 2;
  std::string svg = line(x, axis.y(one.low_whisker), x, axis.y(one.high_whisker), kThin);
  for (const double end : {one.low_whisker, one.high_whisker})
    svg += line(x - kBox / 4, axis.y(end), x + kBox / 4, axis.y(end), kThin);
  svg += printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#9db8e8\" %s/>\n", left,
                 axis.y(one.third_quartile), kBox, axis.y(one.first_quartile) - axis.y(one.third_quartile),
                 kThin);
  svg += line(left, axis.y(one.median), right, axis.y(one.median), kBold);
  for (const double end : {one.least, one.most})
    if (end < one.low_whisker || end > one.high_whisker)
      svg += printed("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"none\" %s/>\n", x, axis.y(end), kThin);
  return svg;
}

std::string row_of(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += printed("<%s>", tag) + escaped(cell) + printed("</%s>", tag);
  return row + "</tr>\n";
}

std::string figure(double value) {
  return std::isinf(value) ? "infinite" : std::isnan(value) ? "–" : printed("%.2f", value);
}

std::string probability(double p) {
  return std::isnan(p) ? "–" : p < 0.0001 ? "< 0.0001" : printed("%.4f", p);
}

std::vector<std::string> test_cells(const std::string& name, const EffectTest& test) {
  return {name, printed("F(%g, %g)", test.df1, test.df2), figure(test.F), probability(test.p),
          figure(test.eta2p)};
}

std::string summary_table(const StudyReport& report, const QuestionReport& question) {
  std::string table =
      "<h3>Answers</h3>\n<table>\n" + row_of({"", "", "median", "quartiles", "mean", "answers"}, "th");
  for (size_t f = 0; f < report.factors.size(); ++f)  // main effects come first
    for (const LevelSummary& one : question.effects[f].summaries)
      table += row_of({question.effects[f].name, one.level, figure(one.median),
                       figure(one.first_quartile) + " to " + figure(one.third_quartile), figure(one.mean),
                       std::to_string(one.count)});
  return table + "</table>\n";
}

std::string participant_table(const StudyReport& report) {
  std::string table = "<h2>Participants</h2>\n<table>\n" +
                      row_of({"", "answers", "attention right", "median time", "replays"}, "th");
  for (const ParticipantReport& one : report.participants)
    table += row_of({one.participant + (one.is_excluded ? " (excluded)" : ""), std::to_string(one.answers),
                     std::isnan(one.attention) ? "–" : printed("%.0f %%", 100 * one.attention),
                     std::isnan(one.median_rt_ms) ? "–" : printed("%.1f s", one.median_rt_ms / 1000),
                     std::to_string(one.replays)});
  return table + "</table>\n";
}

std::string links(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string list;
  for (const auto& [name, text] : files) append_item(list, "<a href=\"" + name + "\">" + name + "</a>");
  return "<p>Tables and plots as files: " + list + ".</p>\n";
}

std::string test_table(const QuestionReport& question) {
  std::string table =
      "<h3>Effects</h3>\n<table>\n" + row_of({"effect", "test", "F", "p", "partial η²"}, "th");
  for (const EffectReport& effect : question.effects) table += row_of(test_cells(effect.name, effect.art));
  for (const EffectReport& effect : question.effects)
    if (!effect.tukey.empty()) table += row_of(test_cells(effect.name + ", one-way on means", effect.plain));
  return table + "</table>\n";
}

std::string pair_table(const QuestionReport& question) {
  std::string table = "<h3>Contrasts of main effects</h3>\n<table>\n" +
                      row_of({"", "", "", "t (ART-C)", "p", "t (means)", "p"}, "th");
  for (const EffectReport& effect : question.effects)
    for (size_t i = 0; i < effect.tukey.size(); ++i) {
      const PairTest &art = effect.contrasts[i], &plain = effect.tukey[i];
      table += row_of({effect.name, effect.levels[art.a], effect.levels[art.b], figure(art.t),
                       probability(art.p), figure(plain.t), probability(plain.p)});
    }
  return table + "</table>\n";
}

std::string preference_tables(const PreferenceReport& preference) {
  std::string page = "<h2>" + escaped(preference.name) + "</h2>\n<table>\n" +
                     row_of({"condition", "chosen where it was shown"}, "th");
  for (const auto& [condition, share] : preference.shares)
    page += row_of({condition, printed("%.0f %%", 100 * share)});
  page += "</table>\n<h3>Pairs</h3>\n<table>\n" +
          row_of({"", "", "answers", "participants who prefer it", "p"}, "th");
  for (const PairPreference& pair : preference.pairs)
    page += row_of({pair.a, pair.b, printed("%d : %d", pair.answers_a, pair.answers_b),
                    printed("%d : %d", pair.participants_a, pair.participants_b), probability(pair.p)});
  return page + "</table>\n";
}

std::string exclusions(const StudyReport& report) {
  if (report.excluded.empty()) return "<p>Nobody is excluded.</p>\n";
  std::string text = "<ul>\n";
  for (const Exclusion& one : report.excluded)
    text += "<li>" + escaped(one.participant + " is excluded: " + one.reason) + "</li>\n";
  return text + "</ul>\n";
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>";
constexpr const char* kStyle =
    "</title>\n<style>\nbody { font: 15px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 "
    "1em; }\n"
    "table { border-collapse: collapse; margin: 1em 0; }\n"
    "td, th { border-bottom: 1px solid #ccd; padding: 0.2em 0.8em; text-align: left; }\n"
    "svg { margin-right: 1em; }\n</style>\n</head>\n<body>\n";
constexpr const char* kPairNotes =
    "<p>Participants prefer the condition that they chose more often; those who chose both equally often "
    "count for neither. p: exact two-sided sign test of the participants, adjusted for all pairs of a "
    "question (Holm 1979).</p>\n";
constexpr const char* kNotes =
    "<p>Effects: analysis of variance of aligned ranks (Wobbrock et al. 2011), each effect against its "
    "interaction with the participants, without sphericity correction. Contrasts: ART-C (Elkin et al. 2021), "
    "and Tukey's honestly significant difference of the participants' means; both adjusted for all pairs. Of "
    "answers on scales of few points aligned ranks find effects that are not there more often than they "
    "should: in 5 to 8 % of simulated designs at the 5 % level, most often with one answer to each "
    "combination. Boxes: quartiles and median of single answers, whiskers to 1.5 times the quartiles' "
    "distance.</p>\n";

std::string counted(const StudyReport& report) {
  std::string factors;
  for (const std::string& name : report.factors) append_item(factors, name);
  return printed("<p>%d of %zu participants are analysed. Factors: ", report.analysed,
                 report.participants.size()) +
         escaped(factors) + ".</p>\n";
}

}  // namespace

std::string box_plot(const std::string& title, const EffectReport& effect) {
  const ValueAxis axis = axis_of(effect.summaries);
  double step = kLeastStep;
  for (const LevelSummary& one : effect.summaries)
    step = std::max(step, kLetter * static_cast<double>(one.level.size()) + 16);
  const double width = kLeft + step * static_cast<double>(effect.summaries.size()) + 16;
  std::string svg = printed(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\" "
      "font-size=\"13\">\n",
      width, kTop + kHeight + 40);
  svg += printed("<text x=\"%.0f\" y=\"22\" font-weight=\"bold\">", kLeft) + escaped(title) + "</text>\n";
  for (int i = 0; axis.low + i * axis.step <= axis.high * (1 + 1e-12); ++i) {
    const double value = axis.low + i * axis.step;
    svg += line(kLeft, axis.y(value), width - 16, axis.y(value), "stroke=\"#dde\"");
    svg += printed("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", kLeft - 8,
                   axis.y(value) + 4, value);
  }
  for (size_t i = 0; i < effect.summaries.size(); ++i) {
    const double x = kLeft + step * (static_cast<double>(i) + 0.5);
    svg += box(effect.summaries[i], x, axis);
    svg += printed("<text x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">", x, kTop + kHeight + 24) +
           escaped(effect.summaries[i].level) + "</text>\n";
  }
  return svg + "</svg>\n";
}

std::vector<std::pair<std::string, std::string>> page_files(const StudyReport& report) {
  auto files = csv_tables(report);
  const std::string title = report.study.empty() ? "Results of a study" : escaped("Results: " + report.study);
  std::string page =
      kHead + title + kStyle + "<h1>" + title + "</h1>\n" + counted(report) + exclusions(report);
  for (size_t q = 0; q < report.questions.size(); ++q) {
    const QuestionReport& question = report.questions[q];
    page += "<h2>" + escaped(question.name) + "</h2>\n<div>\n";
    for (size_t f = 0; f < report.factors.size(); ++f) {
      const EffectReport& effect = question.effects[f];  // main effects come first
      std::string svg = box_plot("“" + question.name + "” by " + effect.name, effect);
      page += svg;
      files.emplace_back(printed("boxes_%zu_%zu.svg", q + 1, f + 1), std::move(svg));
    }
    page += "</div>\n" + test_table(question) + pair_table(question) + summary_table(report, question);
    page += "<p>Agreement between participants, ICC(2,1): " + figure(question.agreement) + ".</p>\n";
  }
  for (const PreferenceReport& preference : report.preferences) page += preference_tables(preference);
  page += participant_table(report) + links(files) + (report.preferences.empty() ? kNotes : kPairNotes);
  files.emplace_back("index.html", page + "</body>\n</html>\n");
  return files;
}

void write_page(const std::string& folder, const StudyReport& report) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  US_CHECK(!failed, folder, ": cannot be made (", failed.message(), ")");
  for (const auto& [name, text] : page_files(report)) write_file(folder + "/" + name, text);
}

}  // namespace understudy::app
