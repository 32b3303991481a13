// The report of an analysis as JSON and as tables.
#include <charconv>
#include <cmath>

#include "app/run/fields_json.hpp"
#include "app/study/analysis.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

Json json_of(const EffectTest& test) {
  return {{"F", test.F}, {"df1", test.df1}, {"df2", test.df2}, {"p", test.p}, {"eta2p", test.eta2p}};
}

Json json_of(const PairTest& pair, const EffectReport& effect) {
  return {{"a", effect.levels[pair.a]},
          {"b", effect.levels[pair.b]},
          {"t", pair.t},
          {"df", pair.df},
          {"p", pair.p}};
}

Json one_way_json(const EffectReport& effect) {
  Json json = json_of(effect.plain);
  json["tukey"] = Json::array();
  for (const PairTest& pair : effect.tukey) {
    Json one = json_of(pair, effect);
    one["difference"] = pair.difference;
    json["tukey"].push_back(std::move(one));
  }
  return json;
}

Json json_of(const QuestionReport& question) {
  Json json = {{"anova", Json::object()},     {"contrasts", Json::array()}, {"medians", Json::object()},
               {"quartiles", Json::object()}, {"one_way", Json::object()},  {"icc", question.agreement}};
  for (const EffectReport& effect : question.effects) {
    json["anova"][effect.name] = json_of(effect.art);
    for (const PairTest& pair : effect.contrasts) {
      Json one = {{"effect", effect.name}};
      one.update(json_of(pair, effect));
      json["contrasts"].push_back(std::move(one));
    }
    for (const LevelSummary& level : effect.summaries) {
      json["medians"][effect.name][level.level] = level.median;
      json["quartiles"][effect.name][level.level] = {level.first_quartile, level.third_quartile};
    }
    if (!effect.tukey.empty()) json["one_way"][effect.name] = one_way_json(effect);
  }
  return json;
}

Json json_of(const PreferenceReport& preference) {
  Json json = {{"shares", Json::object()}, {"pairs", Json::array()}};
  for (const auto& [condition, share] : preference.shares) json["shares"][condition] = share;
  for (const PairPreference& pair : preference.pairs)
    json["pairs"].push_back({{"a", pair.a},
                             {"b", pair.b},
                             {"answers_a", pair.answers_a},
                             {"answers_b", pair.answers_b},
                             {"participants_a", pair.participants_a},
                             {"participants_b", pair.participants_b},
                             {"p", pair.p}});
  return json;
}

/// Lines of cells.
class Table {
 public:
  explicit Table(const std::vector<std::string>& header) {
    for (const std::string& name : header) add(name);
    end_line();
  }
  Table& add(const std::string& text) {
    if (!at_start_) text_ += ',';
    at_start_ = false;
    text_ += csv_cell(text);
    return *this;
  }
  /// Nine digits; nothing for NaN.
  Table& add(double value) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 9).ptr;
    return add(std::isnan(value) ? std::string() : std::string(digits, end));
  }
  void end_line() {
    text_ += '\n';
    at_start_ = true;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool at_start_ = true;
};

std::string anova_table(const StudyReport& report) {
  Table table({"question", "effect", "F", "df1", "df2", "p", "eta2p"});
  for (const QuestionReport& question : report.questions)
    for (const EffectReport& effect : question.effects) {
      const EffectTest& test = effect.art;
      table.add(question.name)
          .add(effect.name)
          .add(test.F)
          .add(test.df1)
          .add(test.df2)
          .add(test.p)
          .add(test.eta2p);
      table.end_line();
    }
  return table.text();
}

std::string pairs_table(const StudyReport& report, std::vector<PairTest> EffectReport::*pairs) {
  Table table({"question", "effect", "a", "b", "difference", "t", "df", "p"});
  for (const QuestionReport& question : report.questions)
    for (const EffectReport& effect : question.effects)
      for (const PairTest& pair : effect.*pairs) {
        table.add(question.name).add(effect.name).add(effect.levels[pair.a]).add(effect.levels[pair.b]);
        table.add(pair.difference).add(pair.t).add(pair.df).add(pair.p).end_line();
      }
  return table.text();
}

std::string medians_table(const StudyReport& report) {
  Table table({"question", "effect", "level", "answers", "min", "q1", "median", "q3", "max", "mean"});
  for (const QuestionReport& question : report.questions)
    for (const EffectReport& effect : question.effects)
      for (const LevelSummary& level : effect.summaries) {
        table.add(question.name).add(effect.name).add(level.level).add(level.count).add(level.least);
        table.add(level.first_quartile).add(level.median).add(level.third_quartile).add(level.most);
        table.add(level.mean).end_line();
      }
  return table.text();
}

std::string preferences_table(const StudyReport& report) {
  Table table({"question", "a", "b", "answers_a", "answers_b", "participants_a", "participants_b", "p"});
  for (const PreferenceReport& preference : report.preferences)
    for (const PairPreference& pair : preference.pairs) {
      table.add(preference.name).add(pair.a).add(pair.b).add(pair.answers_a).add(pair.answers_b);
      table.add(pair.participants_a).add(pair.participants_b).add(pair.p).end_line();
    }
  return table.text();
}

std::string reason_of(const StudyReport& report, const std::string& participant) {
  for (const Exclusion& one : report.excluded)
    if (one.participant == participant) return one.reason;
  return {};
}

std::string participants_table(const StudyReport& report) {
  std::vector<std::string> header = {"participant", "excluded",     "answers",
                                     "attention",   "median_rt_ms", "replays"};
  if (report.preferences.empty())
    for (const QuestionReport& question : report.questions) header.push_back("median " + question.name);
  Table table(header);
  for (const ParticipantReport& one : report.participants) {
    table.add(one.participant).add(reason_of(report, one.participant)).add(one.answers).add(one.attention);
    table.add(one.median_rt_ms).add(one.replays);
    if (report.preferences.empty())
      for (const double median : one.medians) table.add(median);
    table.end_line();
  }
  return table.text();
}

Json json_of(const ParticipantReport& participant, const StudyReport& report) {
  Json json = {{"participant", participant.participant},   {"excluded", participant.is_excluded},
               {"answers", participant.answers},           {"attention", participant.attention},
               {"median_rt_ms", participant.median_rt_ms}, {"replays", participant.replays}};
  for (size_t q = 0; q < report.questions.size(); ++q)
    json["medians"][report.questions[q].name] = participant.medians[q];
  return json;
}

}  // namespace

Json to_json(const StudyReport& report) {
  Json json = {
      {"study", report.study},           {"excluded", Json::array()}, {"exclusion_reasons", Json::object()},
      {"participants", report.analysed}, {"factors", report.factors}, {"questions", Json::object()}};
  for (const Exclusion& one : report.excluded) {
    json["excluded"].push_back(one.participant);
    json["exclusion_reasons"][one.participant] = one.reason;
  }
  for (const QuestionReport& question : report.questions)
    json["questions"][question.name] = json_of(question);
  for (const PreferenceReport& preference : report.preferences)
    json["preferences"][preference.name] = json_of(preference);
  for (const ParticipantReport& one : report.participants)
    json["per_participant"].push_back(json_of(one, report));
  return json;
}

std::vector<std::pair<std::string, std::string>> csv_tables(const StudyReport& report) {
  if (!report.preferences.empty())
    return {{"preferences.csv", preferences_table(report)}, {"participants.csv", participants_table(report)}};
  return {{"anova.csv", anova_table(report)},
          {"contrasts.csv", pairs_table(report, &EffectReport::contrasts)},
          {"tukey.csv", pairs_table(report, &EffectReport::tukey)},
          {"medians.csv", medians_table(report)},
          {"participants.csv", participants_table(report)}};
}

}  // namespace understudy::app
