#include "app/study/trial_exports.hpp"

#include <algorithm>

#include "app/study/answers.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

using Row = std::vector<std::string>;

std::string csv_of(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + csv_cell(row[i]);
    text += '\n';
  }
  return text;
}

/// Characters, not bytes, of UTF-8.
size_t width(const std::string& text) {
  return static_cast<size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string table_of(const std::vector<Row>& rows) {
  std::vector<size_t> widths(rows[0].size(), 0);
  for (const Row& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += row[i] + std::string(widths[i] - width(row[i]) + 2, ' ');
    text += std::string(trim_end(line)) + '\n';
  }
  return text;
}

std::string other_of(const Study& study, const Trial& trial) {
  return trial.other < 0 ? "" : study.conditions[trial.other].name;
}

const Row kFactorNames = {"condition", "other", "motion", "target", "repetition"};

Row factors_of(const Study& study, const Trial& trial) {
  return {study.conditions[trial.condition].name, other_of(study, trial), study.motions[trial.motion].name,
          study.targets[trial.target].name, std::to_string(trial.repetition)};
}

std::string names_of_questions(const Study& study, const Trial& trial) {
  std::string names;
  for (const int q : trial.questions) append_item(names, study.questions[q].name, "; ");
  return names;
}

Row joined(Row first, const Row& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<Row> rows_of(const Study& study, const std::vector<Trial>& trials) {
  std::vector<Row> rows = {joined({"position", "trial", "practice"}, kFactorNames)};
  rows[0].insert(rows[0].end(), {"clip", "questions"});
  for (const Trial& trial : trials) {
    Row row = {std::to_string(rows.size()), trial.id, trial.is_practice ? "1" : "0"};
    row = joined(row, factors_of(study, trial));
    row.insert(row.end(), {clip_path(study, trial), names_of_questions(study, trial)});
    rows.push_back(row);
  }
  return rows;
}

bool is_asked(const Trial& trial, int question) {
  return std::find(trial.questions.begin(), trial.questions.end(), question) != trial.questions.end();
}

std::string listed(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& option : options) append_item(text, option, "|");
  return text;
}

Row question_columns(const Study& study, const Trial& trial, int q) {
  const StudyQuestion& one = study.questions[q];
  const std::string points = one.kind == QuestionKind::Likert ? std::to_string(one.points) : "";
  return {one.name,
          is_asked(trial, q) ? "1" : "0",
          kQuestionKindNames[static_cast<size_t>(one.kind)],
          one.text,
          points,
          one.low,
          one.high,
          listed(one.options),
          right_answer(one, study.motions[trial.motion])};
}

Json data_of(const Study& study, const Trial& trial) {
  Json data = {{"trial", trial.id}, {"practice", trial.is_practice}};
  const Row factors = factors_of(study, trial);
  for (size_t i = 0; i < factors.size(); ++i) data[kFactorNames[i]] = factors[i];
  data["repetition"] = trial.repetition;
  return data;
}

Json video_json(const Study& study, const Trial& trial) {
  Json data = data_of(study, trial);
  data["part"] = "clip";
  return {{"type", "video-keyboard-response"},
          {"stimulus", Json::array({clip_path(study, trial)})},
          {"choices", "NO_KEYS"},
          {"trial_ends_after_video", true},
          {"data", data}};
}

Json break_json() {
  return {{"type", "html-button-response"},
          {"stimulus", "Time for a break."},
          {"choices", Json::array({"Continue"})},
          {"data", {{"part", "break"}}}};
}

Json question_json(const Study& study, const Trial& trial, const StudyQuestion& one) {
  Json data = data_of(study, trial);
  data["part"] = "question";
  data["question"] = one.name;
  const std::string& right = right_answer(one, study.motions[trial.motion]);
  if (!right.empty()) data["right"] = right;
  Json question = {{"prompt", one.text}, {"name", one.name}, {"required", true}};
  if (one.kind != QuestionKind::Likert) {
    question["options"] = one.options;
    return {{"type", "survey-multi-choice"}, {"questions", Json::array({question})}, {"data", data}};
  }
  for (int point = 1; point <= one.points; ++point) {
    const std::string end = point == 1 ? one.low : point == one.points ? one.high : "";
    question["labels"].push_back(end.empty() ? std::to_string(point) : std::to_string(point) + "<br>" + end);
  }
  return {{"type", "survey-likert"}, {"questions", Json::array({question})}, {"data", data}};
}

}  // namespace

const std::vector<std::string>& trial_factor_names() {
  static const std::vector<std::string> names = joined(kFactorNames, {"practice"});
  return names;
}

std::vector<std::string> trial_factors(const Study& study, const Trial& trial) {
  return joined(factors_of(study, trial), {trial.is_practice ? "1" : "0"});
}

std::string clip_path(const Study& study, const Trial& trial) {
  return "clips/" + clip_name(study, trial) + ".mp4";
}

std::string trials_as_table(const Study& study, const std::vector<Trial>& trials) {
  std::vector<Row> rows = rows_of(study, trials);
  const bool pairs = study.layout.results == TrialResults::Pair;
  for (Row& row : rows) {
    row.erase(row.begin() + 8);              // the clip: its name tells nothing
    if (!pairs) row.erase(row.begin() + 4);  // the other condition
    row.erase(row.begin() + 2);              // practice: the trial's name says so
  }
  return table_of(rows);
}

std::string trials_as_csv(const Study& study, const std::vector<Trial>& trials) {
  return csv_of(rows_of(study, trials));
}

std::string trials_for_psychopy(const Study& study, const std::vector<Trial>& trials) {
  std::vector<Row> rows = {joined({"trial", "practice", "clip"}, kFactorNames)};
  const int questions = static_cast<int>(study.questions.size());
  for (int q = 0; q < questions; ++q)
    for (const char* part : {"name", "ask", "kind", "text", "points", "low", "high", "options", "right"})
      rows[0].push_back(printed("q%d_%s", q + 1, part));
  for (const Trial& trial : trials) {
    Row row = {trial.id, trial.is_practice ? "1" : "0", clip_path(study, trial)};
    row = joined(row, factors_of(study, trial));
    for (int q = 0; q < questions; ++q) row = joined(row, question_columns(study, trial, q));
    rows.push_back(row);
  }
  return csv_of(rows);
}

std::string trials_for_jspsych(const Study& study, const std::vector<Trial>& trials) {
  Json timeline = Json::array();
  int done = 0;
  for (const Trial& trial : trials) {
    const int every = study.plan.break_every;
    if (every > 0 && done > 0 && done % every == 0) timeline.push_back(break_json());
    if (!trial.is_practice) ++done;
    timeline.push_back(video_json(study, trial));
    for (const int q : trial.questions) timeline.push_back(question_json(study, trial, study.questions[q]));
  }
  return json_text({{"study", study.name}, {"timeline", timeline}});
}

const std::vector<TrialFormat>& trial_formats() {
  static const std::vector<TrialFormat> all = {
      {"table", "Table", ".txt", trials_as_table},
      {"csv", "CSV", ".csv", trials_as_csv},
      {"jspsych", "jsPsych timeline", ".json", trials_for_jspsych},
      {"psychopy", "PsychoPy conditions", ".csv", trials_for_psychopy}};
  return all;
}

const TrialFormat& trial_format(const std::string& name) {
  std::string names;
  for (const TrialFormat& format : trial_formats()) {
    if (name == format.name) return format;
    append_item(names, format.name);
  }
  throw Error("there is no format '" + name + "' for trials: " + names);
}

}  // namespace understudy::app
