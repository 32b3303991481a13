#include "app/cli/study_analyse.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/run/report.hpp"
#include "app/study/analysis.hpp"
#include "app/study/analysis_page.hpp"
#include "app/study/study_analysis.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

struct StudyAnalyseOptions {
  std::string study, answers, out, page;
  std::vector<std::string> questions, factors, attention;
  std::optional<double> least_attention;  ///< per cent
};

/// The two sides of NAME=REST. Throws Error where there is no "=".
std::pair<std::string, std::string> sides(const std::string& option, const std::string& text) {
  const size_t at = text.find('=');
  US_CHECK(at != text.npos && at > 0 && at + 1 < text.size(), "--", option, " ", text, ": wants NAME=...");
  return {text.substr(0, at), text.substr(at + 1)};
}

/// NAME=1..7 or NAME=adult|child.
RatedQuestion question_from(const std::string& text) {
  const auto [name, scale] = sides("question", text);
  RatedQuestion question{name};
  const size_t dots = scale.find("..");
  if (dots == scale.npos) {
    question.choices = split(scale, '|');
    US_CHECK(question.choices.size() >= 2, "--question ", text,
             ": wants a scale as 1..7 or options as yes|no");
    return question;
  }
  US_CHECK(parse_number(scale.substr(0, dots), question.low) &&
               parse_number(scale.substr(dots + 2), question.high) && question.low < question.high,
           "--question ", text, ": \"", scale, "\" is not a scale");
  return question;
}

/// QUESTION=RIGHT, or QUESTION=@FACTOR.
AttentionCheck attention_from(const std::string& text) {
  AttentionCheck check;
  const auto [name, right] = sides("attention", text);
  check.question = name;
  (right[0] == '@' ? check.column : check.right) = right[0] == '@' ? right.substr(1) : right;
  return check;
}

/// What the study says, if there is one, but for what the command line says.
AnalysisOptions options_for(const std::optional<Study>& study, const StudyAnalyseOptions& options) {
  AnalysisOptions analysis = study ? analysis_options(*study) : AnalysisOptions();
  if (!options.questions.empty()) analysis.questions.clear();
  for (const std::string& one : options.questions) analysis.questions.push_back(question_from(one));
  if (!options.factors.empty()) analysis.factors = options.factors;
  if (!options.attention.empty()) analysis.attention.clear();
  for (const std::string& one : options.attention) analysis.attention.push_back(attention_from(one));
  if (options.least_attention) analysis.least_attention = *options.least_attention / 100;
  return analysis;
}

void print(const StudyReport& report) {
  std::printf("%d of %zu participants analysed\n", report.analysed, report.participants.size());
  for (const Exclusion& one : report.excluded)
    std::printf("%s is excluded: %s\n", one.participant.c_str(), one.reason.c_str());
  for (const QuestionReport& question : report.questions)
    for (const EffectReport& effect : question.effects)
      std::printf("%s, %s: F(%g, %g) = %.2f, p = %.2g, partial eta2 = %.2f\n", question.name.c_str(),
                  effect.name.c_str(), effect.art.df1, effect.art.df2, effect.art.F, effect.art.p,
                  effect.art.eta2p);
  for (const PreferenceReport& preference : report.preferences)
    for (const PairPreference& pair : preference.pairs)
      std::printf("%s: %s is chosen %d times, %s %d times; %d and %d participants prefer it, p = %.2g\n",
                  preference.name.c_str(), pair.a.c_str(), pair.answers_a, pair.b.c_str(), pair.answers_b,
                  pair.participants_a, pair.participants_b, pair.p);
}

int study_analyse(const StudyAnalyseOptions& options) {
  check_writable(options.out);
  std::optional<Study> study;
  if (!options.study.empty()) study = read_study(options.study);
  const AnalysisOptions how = options_for(study, options);
  StudyAnswers answers = read_answers(options.answers);
  if (study) answers = counted_answers(std::move(answers), *study, folder_of_file(options.study));
  const StudyReport report = analyse(answers, how);
  if (!options.page.empty()) write_page(options.page, report);
  if (!options.out.empty()) write_json(options.out, to_json(report));
  print(report);
  return 0;
}

}  // namespace

void add_study_analyse(CLI::App& study, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<StudyAnalyseOptions>();
  CLI::App& command =
      *study.add_subcommand("analyse", "statistics of the answers: aligned ranks, contrasts, medians");
  command.add_option(
      "study", options->study,
      "the .study file: questions, scales, factors and the rule of exclusion (default: as told by options)");
  command.add_option("--answers", options->answers, "folder of CSV files, one a participant")->required();
  command.add_option("--out", options->out, "report as JSON");
  command.add_option("--page", options->page, "folder for a page with box plots, and tables as CSV");
  command.add_option(
      "--question", options->questions,
      "a question and its scale, NAME=1..7, or its options, NAME=adult|child (default: all, 1..7)");
  command.add_option("--factor", options->factors,
                     "a factor to analyse (default: all columns with two levels or more, but repetition)");
  command.add_option("--attention", options->attention,
                     "a question of attention and its right answer, NAME=ANSWER, or NAME=@FACTOR where it is "
                     "the trial's level of that factor");
  command
      .add_option("--least-attention", options->least_attention,
                  "excludes who has fewer right answers than this, per cent (default: 50)")
      ->check(CLI::Range(0.0, 100.0));
  command.callback([options, chosen] { *chosen = [options] { return study_analyse(*options); }; });
}

}  // namespace understudy::app
