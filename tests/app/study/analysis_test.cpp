#include "app/study/analysis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

const std::string kData = US_SOURCE_DIR "/tests/data/study/";

AttentionCheck action_is_motion() {
  AttentionCheck check;
  check.question = "action";
  check.column = "motion";
  return check;
}

/// The report of a folder of tests/data/study.
StudyReport report_of(const std::string& set) {
  AnalysisOptions options;
  options.factors = {"method", "motion"};
  if (set == "likert") options.factors.emplace_back("shape");
  if (set == "slider") options.questions = {{"naturalness", 0, 100}};
  if (set == "exclusions") options.attention = {action_is_motion()};
  return analyse(read_answers(kData + set), options);
}

/// The parts of an interaction's name may be in any order: "a:b" and "b:a".
std::vector<std::string> sorted_parts(const std::string& name) {
  std::vector<std::string> parts = split(name, ':');
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// The line of R's table: set, kind, effect, a, b, F, df1, df2, p, eta2p, t.
struct Expected {
  explicit Expected(const std::string& line) : cells(csv_cells(line)) {}
  double number(size_t column) const {
    return cells[column].empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cells[column]);
  }
  std::vector<std::string> cells;
};

/// Four significant digits.
void expect_same(double ours, double of_r, const std::string& where) {
  EXPECT_NEAR(ours, of_r, 5e-5 * std::abs(of_r) + 1e-9) << where;
}

void expect_test(const EffectTest& test, const Expected& r, const std::string& where) {
  expect_same(test.F, r.number(5), where);
  EXPECT_EQ(test.df1, r.number(6)) << where;
  EXPECT_EQ(test.df2, r.number(7)) << where;
  expect_same(test.p, r.number(8), where);
  expect_same(test.eta2p, r.number(9), where);
}

void expect_pair(const EffectReport& effect, const std::vector<PairTest>& pairs, const Expected& r,
                 const std::string& where) {
  for (const PairTest& pair : pairs) {
    const std::string &a = effect.levels[pair.a], &b = effect.levels[pair.b];
    const bool turned = a == r.cells[4] && b == r.cells[3];
    if (!turned && (a != r.cells[3] || b != r.cells[4])) continue;
    expect_same(turned ? -pair.t : pair.t, r.number(10), where);
    EXPECT_EQ(pair.df, r.number(7)) << where;
    expect_same(pair.p, r.number(8), where);
    return;
  }
  ADD_FAILURE() << where << " is not there";
}

void expect_median(const EffectReport& effect, const Expected& r, const std::string& where) {
  for (const LevelSummary& level : effect.summaries) {
    if (level.level != r.cells[3]) continue;
    expect_same(level.median, r.number(5), where);
    expect_same(level.first_quartile, r.number(6), where);
    expect_same(level.third_quartile, r.number(7), where);
    return;
  }
  ADD_FAILURE() << where << " is not there";
}

class AnalysisByR : public testing::TestWithParam<const char*> {};

TEST_P(AnalysisByR, IsOurs) {
  const std::string set = GetParam();
  const StudyReport report = report_of(set);
  ASSERT_EQ(report.questions.size(), 1u);
  const std::string table = read_file(kData + "expected.csv");
  TextCursor lines(table, "expected.csv");
  int compared = 0;
  while (!lines.at_end()) {
    const Expected r(std::string(lines.line()));
    if (r.cells[0] != set) continue;
    const std::string where = r.cells[1] + " " + r.cells[2] + " " + r.cells[3] + " - " + r.cells[4];
    for (const EffectReport& effect : report.questions[0].effects) {
      if (sorted_parts(effect.name) != sorted_parts(r.cells[2])) continue;
      const bool is_main = effect.name.find(':') == effect.name.npos;
      const std::string& kind = r.cells[1];
      compared += kind == "art" || kind == "artc" || kind == "median" || is_main;
      if (kind == "art") expect_test(effect.art, r, where);
      if (kind == "artc") expect_pair(effect, effect.contrasts, r, where);
      if (kind == "median") expect_median(effect, r, where);
      if (kind == "anova" && is_main) expect_test(effect.plain, r, where);
      if (kind == "tukey" && is_main) expect_pair(effect, effect.tukey, r, where);
    }
  }
  EXPECT_GE(compared, 30);
}
INSTANTIATE_TEST_SUITE_P(Sets, AnalysisByR, testing::Values("slider", "likert", "exclusions"),
                         [](const auto& set) { return std::string(set.param); });

TEST(Analysis, ExcludesWhoWasNotAttentiveOrLeftAnAnswerOut) {
  const StudyReport report = report_of("exclusions");
  ASSERT_EQ(report.excluded.size(), 3u);
  EXPECT_EQ(report.excluded[0].participant, "E04");
  EXPECT_EQ(report.excluded[0].reason, "answered 33 % of the attention questions right, less than 50 %");
  EXPECT_EQ(report.excluded[1].participant, "E07");
  EXPECT_EQ(report.excluded[1].reason, "has 8 of 9 answers to \"shape\"");
  EXPECT_EQ(report.excluded[2].participant, "E11");
  EXPECT_EQ(report.analysed, 11);
  ASSERT_EQ(report.participants.size(), 14u);
  EXPECT_NEAR(report.participants[1].attention, 5.0 / 9, 1e-12);
  EXPECT_TRUE(report.participants[3].is_excluded);
}

TEST(Analysis, MayWantMoreThanTheShareOfAttention) {
  AnalysisOptions options;
  options.factors = {"method"};
  options.attention = {action_is_motion()};
  options.least_attention = 5.0 / 9;
  const StudyAnswers answers = read_answers(kData + "exclusions");
  EXPECT_EQ(analyse(answers, options).excluded.size(), 3u);
  options.must_exceed = true;
  const StudyReport report = analyse(answers, options);
  ASSERT_EQ(report.excluded.size(), 4u);
  EXPECT_EQ(report.excluded[0].participant, "E02");
  EXPECT_EQ(report.excluded[0].reason, "answered 56 % of the attention questions right, not more than 56 %");
}

TEST(Analysis, BecomesJsonAndTables) {
  const auto json = to_json(report_of("exclusions"));
  EXPECT_EQ(json["excluded"], (nlohmann::ordered_json{"E04", "E07", "E11"}));
  const auto& question = json["questions"]["shape"];
  for (const char* effect : {"method", "motion", "method:motion"})
    for (const char* key : {"F", "df1", "df2", "p", "eta2p"})
      EXPECT_TRUE(question["anova"][effect][key].is_number()) << effect << key;
  const auto& contrast = question["contrasts"][0];
  EXPECT_EQ(contrast["a"], "H4D");
  EXPECT_EQ(contrast["b"], "TST");
  EXPECT_TRUE(contrast["t"].is_number() && contrast["p"].is_number());
  EXPECT_EQ(question["medians"]["method"]["ours"], 5);
  EXPECT_EQ(json["per_participant"].size(), 14u);

  const auto tables = csv_tables(report_of("exclusions"));
  ASSERT_EQ(tables.size(), 5u);
  EXPECT_EQ(tables[0].second.substr(0, 67),
            "question,effect,F,df1,df2,p,eta2p\nshape,method,14.2906013,2,20,0.00");
  for (const auto& [name, text] : tables) {
    TextCursor lines(text, name);
    const size_t columns = csv_cells(std::string(lines.line())).size();
    while (!lines.at_end()) EXPECT_EQ(csv_cells(std::string(lines.line())).size(), columns) << name;
  }
}

/// Everybody answers "motion" once in each trial; the better the method, the higher.
StudyAnswers made_answers(int participants, int methods, int motions, int repetitions) {
  StudyAnswers all;
  all.factors = {"method", "motion"};
  Rng rng(5);
  for (int i = 0; i < participants; ++i) {
    ParticipantAnswers one{"P" + std::to_string(1000 + i), "P" + std::to_string(1000 + i) + ".csv", {}};
    for (int trial = 0; trial < methods * motions * repetitions; ++trial) {
      const int method = trial % methods, motion = trial / methods % motions;
      const double value = std::clamp(std::round(3.5 + 0.4 * method + 1.2 * rng.normal()), 1.0, 7.0);
      one.answers.push_back({std::to_string(trial),
                             "motion",
                             printed("%g", value),
                             900,
                             0,
                             "",
                             {"m" + std::to_string(method), "c" + std::to_string(motion)},
                             static_cast<size_t>(trial + 2)});
    }
    all.participants.push_back(std::move(one));
  }
  return all;
}

std::string complaint_of(const StudyAnswers& answers, const AnalysisOptions& options = {}) {
  return failure_of([&] { analyse(answers, options); });
}

TEST(Analysis, RefusesAnswersOutsideTheScale) {
  StudyAnswers answers = made_answers(3, 2, 2, 1);
  EXPECT_EQ(complaint_of(answers), "");
  answers.participants[1].answers[2].answer = "8";
  EXPECT_EQ(complaint_of(answers),
            "P1001.csv: line 4: \"8\" is outside the scale of the question \"motion\", 1 to 7");
  answers.participants[1].answers[2].answer = "good";
  EXPECT_NE(complaint_of(answers).find("P1001.csv: line 4: \"good\" is outside"), std::string::npos);
}

TEST(Analysis, RefusesOneParticipant) {
  EXPECT_EQ(complaint_of(made_answers(1, 2, 2, 1)),
            "there are answers of one participant only: statistics need at least two");
  StudyAnswers answers = made_answers(3, 2, 2, 1);
  answers.participants[1].answers[0].answer.clear();
  answers.participants[2].answers[0].answer.clear();
  EXPECT_EQ(complaint_of(answers),
            "there are answers of one participant only: statistics need at least two; 2 excluded, the first "
            "because P1001 has 3 of 4 answers to \"motion\"");
}

TEST(Analysis, RefusesOneCondition) {
  EXPECT_EQ(complaint_of(made_answers(3, 1, 1, 4)),
            "all answers are of one condition: there is nothing to compare");
  AnalysisOptions options;
  options.factors = {"method"};
  EXPECT_EQ(complaint_of(made_answers(3, 1, 2, 4), options),
            "all answers are of one method, \"m0\": there is nothing to compare");
}

TEST(Analysis, RefusesNamesThatAreNotThere) {
  const StudyAnswers answers = made_answers(3, 2, 2, 1);
  AnalysisOptions options;
  options.factors = {"shape"};
  EXPECT_EQ(complaint_of(answers, options), "the answers have no column \"shape\"");
  options.factors.clear();
  options.questions = {{"beauty"}};
  EXPECT_EQ(complaint_of(answers, options), "nobody answered the question \"beauty\"");
  options.questions.clear();
  options.attention = {action_is_motion()};
  EXPECT_EQ(complaint_of(answers, options), "nobody answered the question of attention, \"action\"");
}

TEST(Analysis, DropsWhoHasFewerTrialsOrAnEmptyCell) {
  StudyAnswers answers = made_answers(5, 2, 2, 2);
  answers.participants[0].answers.pop_back();
  answers.participants[2].answers[0].levels[0] = answers.participants[2].answers[4].levels[0] = "m1";
  const StudyReport report = analyse(answers, {});
  ASSERT_EQ(report.excluded.size(), 2u);
  EXPECT_EQ(report.excluded[0].reason, "has 7 of 8 answers to \"motion\"");
  EXPECT_EQ(report.excluded[1].reason, "has no answer to \"motion\" for m0, c0");
}

TEST(Analysis, LeavesPracticeAndRepetitionsOut) {
  StudyAnswers answers = made_answers(4, 2, 1, 4);
  answers.factors = {"method", "practice", "repetition"};
  for (auto& participant : answers.participants)
    for (size_t t = 0; t < participant.answers.size(); ++t)
      participant.answers[t].levels = {t % 2 == 0 ? "a" : "b", t < 2 ? "1" : "0", std::to_string(t / 2)};
  const auto medians = [&] { return analyse(answers, {}).questions[0].effects[0].summaries; };
  ASSERT_EQ(analyse(answers, {}).factors, std::vector<std::string>{"method"});
  EXPECT_EQ(medians()[0].count, 12);
}

TEST(Analysis, HasWhiskersThatEndBeforeOutliers) {
  StudyAnswers answers = made_answers(2, 2, 1, 5);
  const std::vector<std::string> first = {"3", "4", "4", "5", "5"}, second = {"3", "4", "4", "5", "7"};
  for (size_t t = 0; t < 10; ++t) {
    answers.participants[0].answers[t].answer = first[t / 2];
    answers.participants[1].answers[t].answer = second[t / 2];
  }
  const LevelSummary box = analyse(answers, {}).questions[0].effects[0].summaries[0];
  EXPECT_EQ(box.first_quartile, 4);
  EXPECT_EQ(box.third_quartile, 5);
  EXPECT_EQ(box.low_whisker, 3);
  EXPECT_EQ(box.high_whisker, 5);
  EXPECT_EQ(box.most, 7);
}

TEST(Analysis, TakesChoicesAsShares) {
  StudyAnswers answers = made_answers(4, 2, 1, 4);
  for (auto& participant : answers.participants)
    for (size_t t = 0; t < participant.answers.size(); ++t)
      participant.answers[t].answer = t % 2 == 0 && t != 0 ? "child" : "adult";
  answers.participants[0].answers[0].answer = "child";
  AnalysisOptions options;
  options.questions = {{"motion", 0, 1, {"adult", "child"}}};
  const StudyReport report = analyse(answers, options);
  ASSERT_EQ(report.factors, std::vector<std::string>{"method"});
  const EffectReport& method = report.questions[0].effects[0];
  EXPECT_NEAR(method.summaries[0].mean, 13.0 / 16, 1e-12);
  EXPECT_EQ(method.summaries[1].mean, 0);
  EXPECT_EQ(method.plain.df2, 3);
  EXPECT_LT(method.tukey[0].p, 0.01);
  answers.participants[0].answers[1].answer = "robot";
  EXPECT_EQ(complaint_of(answers, options),
            "P1000.csv: line 3: \"robot\" is not an option of the question \"motion\"");
}

TEST(Analysis, ComparesWithTheRightAnswerOfALevel) {
  StudyAnswers answers = made_answers(4, 2, 2, 1);
  for (auto& participant : answers.participants)
    for (size_t t = 0; t < 4; ++t) {
      StudyAnswer asked = participant.answers[t];
      asked.question = "action";
      asked.answer = asked.levels[1] == "c0" ? "Jumping" : "c1";
      participant.answers.push_back(asked);
    }
  AnalysisOptions options;
  options.attention = {action_is_motion()};
  options.attention[0].right_of_level = {{"c0", "jumping"}};
  options.least_attention = 1;
  EXPECT_TRUE(analyse(answers, options).excluded.empty());
  StudyAnswers never_asked = answers;
  never_asked.participants[3].answers.resize(4);
  ASSERT_EQ(analyse(never_asked, options).excluded.size(), 1u);
  EXPECT_EQ(analyse(never_asked, options).excluded[0].reason, "has no answer to \"action\"");
  options.attention[0].right_of_level.clear();
  EXPECT_NE(complaint_of(answers, options).find("answered 50 % of the attention questions right"),
            std::string::npos);
}

}  // namespace
}  // namespace understudy::app
