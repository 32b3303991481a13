// From the answers of a study to its statistics: exclusions, tests, contrasts, medians.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/study/answers.hpp"
#include "app/study/statistics.hpp"

namespace understudy::app {

/// A question whose answers are analysed.
struct RatedQuestion {
  std::string name;
  double low = 1, high = 7;  ///< the scale; numbers between whole points are allowed (sliders)
  /// The options of a choice: answers are these texts and count as 0, 1, ... (of two, the mean is the share
  /// of the second). Empty: a scale.
  std::vector<std::string> choices{};
};

/// A question that shows who paid attention.
struct AttentionCheck {
  std::string question;
  std::string right;   ///< the right answer; empty: by the trial's level of the factor `column`
  std::string column;  ///< a factor, in the analysis or not
  std::map<std::string, std::string> right_of_level{};  ///< level -> answer; a level not here is its own
};

struct AnalysisOptions {
  std::vector<RatedQuestion> questions;  ///< empty: all but that of attention, on a scale from 1 to 7
  std::vector<std::string> factors;      ///< empty: all that have two levels or more
  std::vector<AttentionCheck> attention;
  double least_attention = 0.5;  ///< who has a smaller share of right answers to all of these is excluded
  bool must_exceed = false;      ///< so is who has exactly this share
  /// Each trial showed two conditions: answers name the one that was chosen as paired() says, and the only
  /// factor is kPairFactor.
  bool pairs = false;
  int most_contrast_levels = 16;  ///< interactions with more combinations of levels get no contrasts
  std::string study{};            ///< its name, for the report
};

struct Exclusion {
  std::string participant, reason;  ///< a sentence
};

/// Median and quartiles of single answers, as R's quantile (type 7), and their mean.
struct LevelSummary {
  std::string level;
  double median = 0, first_quartile = 0, third_quartile = 0, mean = 0;
  double least = 0, most = 0;
  double low_whisker = 0,
         high_whisker = 0;  ///< the last answers within 1.5 times the quartiles' distance of them
  int count = 0;
};

/// One effect in one question.
struct EffectReport {
  std::string name;                 ///< "method", or "method:motion"
  std::vector<std::string> levels;  ///< "ours", or "ours, walk"
  EffectTest art;                   ///< ANOVA of aligned ranks
  std::vector<PairTest> contrasts;  ///< ART-C; a and b index levels; empty where there are too many
  EffectTest plain;  ///< of a main effect: one-way repeated-measures ANOVA of the participants' means
  std::vector<PairTest> tukey;          ///< of a main effect: Tukey's HSD of those means
  std::vector<LevelSummary> summaries;  ///< as contrasts, where there are not too many
};

struct QuestionReport {
  std::string name;
  std::vector<EffectReport> effects;
  double agreement = 0;  ///< ICC(2,1) between participants, over the cells of the design
};

/// Two conditions that were shown side by side, in one question.
struct PairPreference {
  std::string a, b;
  int answers_a = 0, answers_b = 0;            ///< that chose it
  int participants_a = 0, participants_b = 0;  ///< who chose it more often than the other
  double p = 1;  ///< two-sided exact sign test of these participants, adjusted for all pairs (Holm 1979)
};
struct PreferenceReport {
  std::string name;  ///< of the question
  std::vector<PairPreference> pairs;
  std::vector<std::pair<std::string, double>>
      shares;  ///< how often a condition was chosen where it was shown
};

struct ParticipantReport {
  std::string participant;
  int answers = 0, replays = 0;
  double attention = 0;         ///< share of right answers; NaN: never asked
  double median_rt_ms = 0;      ///< NaN: not known
  std::vector<double> medians;  ///< of each question
  bool is_excluded = false;
};

struct StudyReport {
  std::string study;  ///< its name; empty: not known
  std::vector<std::string> factors;
  std::vector<Exclusion> excluded;
  std::vector<QuestionReport> questions;
  std::vector<PreferenceReport> preferences;    ///< in place of questions, where trials showed two conditions
  std::vector<ParticipantReport> participants;  ///< everybody
  int analysed = 0;                             ///< participants
};

constexpr const char* kPairFactor = "pair";
/// The level of kPairFactor for two conditions, and what the answers "first" and "second" are about.
std::string paired(const std::string& first, const std::string& second);

/// The whole analysis. Answers whose factor "practice" is 1 do not count. Excluded is who answered the
/// question of attention wrong too often, and who has missing answers: an empty one, fewer than most
/// participants, or none in a cell of the design. Throws Error: an answer outside its scale (naming file and
/// line), an unknown question or factor, one participant, one condition.
StudyReport analyse(const StudyAnswers& answers, const AnalysisOptions& options);

/// {"study": NAME, "excluded": [PARTICIPANT], "exclusion_reasons": {PARTICIPANT: SENTENCE}, "participants",
/// "factors", "questions": {NAME: {"anova": {EFFECT: {"F", "df1", "df2", "p", "eta2p"}}, "contrasts":
/// [{"effect", "a", "b", "t", "df", "p"}], "medians": {EFFECT: {LEVEL: median}}, "quartiles": {EFFECT:
/// {LEVEL: [first, third]}}, "one_way": {FACTOR: {"F", ..., "tukey": [{"a", "b", "difference", "t", "df",
/// "p"}]}}, "icc": agreement}}, "preferences": {NAME: {"shares": {CONDITION: share}, "pairs": [{"a", "b",
/// "answers_a", "answers_b", "participants_a", "participants_b", "p"}]}}, "per_participant": [...]}. NaN and
/// infinity are null.
nlohmann::ordered_json to_json(const StudyReport& report);
/// File names and their text: anova.csv, contrasts.csv, tukey.csv, medians.csv, participants.csv;
/// preferences.csv where there are any.
std::vector<std::pair<std::string, std::string>> csv_tables(const StudyReport& report);

}  // namespace understudy::app
