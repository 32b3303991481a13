#include "app/study/analysis.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/percentile.hpp"

namespace understudy::app {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int64_t kMostCells = 4096;
constexpr char kBetween = '\x1f';  // no name has it
constexpr const char *kRepetition = "repetition", *kPractice = "practice";

/// The chosen factors of the answers and their levels.
struct Design {
  std::vector<std::string> names;
  std::vector<size_t> columns;                   ///< in StudyAnswer::levels
  std::vector<std::vector<std::string>> levels;  ///< sorted
  std::vector<int> counts;

  int cell_count() const {
    int cells = 1;
    for (const int count : counts) cells *= count;
    return cells;
  }
  int cell_of(const StudyAnswer& answer) const {
    int cell = 0;
    for (size_t f = 0; f < columns.size(); ++f) {
      const auto& all = levels[f];
      const auto at = std::lower_bound(all.begin(), all.end(), answer.levels[columns[f]]);
      cell = cell * counts[f] + static_cast<int>(at - all.begin());
    }
    return cell;
  }
  /// "ours, walk": the levels of an effect's factors in a cell.
  std::string level_name(int cell, Effect effect) const {
    std::vector<std::string> parts;
    for (size_t f = columns.size(); f-- > 0; cell /= counts[f])
      if ((effect >> f & 1u) != 0) parts.push_back(levels[f][cell % counts[f]]);
    std::string name;
    for (size_t i = parts.size(); i-- > 0;) append_item(name, parts[i]);
    return name;
  }
  std::string effect_name(Effect effect) const {
    std::string name;
    for (size_t f = 0; f < names.size(); ++f)
      if ((effect >> f & 1u) != 0) append_item(name, names[f], ":");
    return name;
  }
};

/// Without the answers whose factor "practice" is 1.
StudyAnswers without_practice(StudyAnswers answers) {
  const auto at = std::find(answers.factors.begin(), answers.factors.end(), kPractice);
  if (at == answers.factors.end()) return answers;
  const auto column = static_cast<size_t>(at - answers.factors.begin());
  for (auto& participant : answers.participants) {
    auto& list = participant.answers;
    list.erase(
        std::remove_if(list.begin(), list.end(), [&](const auto& one) { return one.levels[column] == "1"; }),
        list.end());
  }
  return answers;
}

const RatedQuestion* find(const std::vector<RatedQuestion>& questions, const std::string& name) {
  for (const RatedQuestion& one : questions)
    if (one.name == name) return &one;
  return nullptr;
}

/// The questions asked for, or all; each of them is in the answers.
std::vector<RatedQuestion> questions_of(const StudyAnswers& answers, const AnalysisOptions& options) {
  std::vector<std::string> asked;
  for (const auto& participant : answers.participants)
    for (const StudyAnswer& one : participant.answers)
      if (std::find(asked.begin(), asked.end(), one.question) == asked.end()) asked.push_back(one.question);
  const auto is_asked = [&](const std::string& name) {
    return std::find(asked.begin(), asked.end(), name) != asked.end();
  };
  for (const AttentionCheck& one : options.attention)
    US_CHECK(is_asked(one.question), "nobody answered the question of attention, \"", one.question, "\"");
  const auto is_check = [&](const std::string& name) {
    return std::any_of(options.attention.begin(), options.attention.end(),
                       [&](const auto& one) { return one.question == name; });
  };
  std::vector<RatedQuestion> questions = options.questions;
  if (questions.empty())
    for (const std::string& name : asked)
      if (!is_check(name)) questions.push_back({name});
  US_CHECK(!questions.empty(), "the answers have no question to analyse");
  for (const RatedQuestion& one : questions)
    US_CHECK(is_asked(one.name), "nobody answered the question \"", one.name, "\"");
  return questions;
}

std::vector<std::string> levels_of(const StudyAnswers& answers, const std::vector<RatedQuestion>& questions,
                                   size_t column) {
  std::set<std::string> levels;
  for (const auto& participant : answers.participants)
    for (const StudyAnswer& one : participant.answers)
      if (find(questions, one.question) != nullptr) levels.insert(one.levels[column]);
  return {levels.begin(), levels.end()};
}

/// least: levels that a factor which is asked for must have.
Design design_of(const StudyAnswers& answers, const std::vector<RatedQuestion>& questions,
                 const std::vector<std::string>& wanted, int64_t least = 2) {
  Design design;
  int64_t cells = 1;
  for (const std::string& name : wanted.empty() ? answers.factors : wanted) {
    if (wanted.empty() && (name == kRepetition || name == kPractice)) continue;
    const size_t column = column_of(answers, name);
    std::vector<std::string> levels = levels_of(answers, questions, column);
    US_CHECK(ssize(levels) >= least || wanted.empty(), "all answers are of one ", name, ", \"",
             levels.front(), "\": there is nothing to compare");
    if (ssize(levels) < least) continue;
    design.names.push_back(name);
    design.columns.push_back(column);
    design.counts.push_back(static_cast<int>(levels.size()));
    cells *= ssize(levels);
    design.levels.push_back(std::move(levels));
    US_CHECK(cells <= kMostCells, "the factors have more than ", kMostCells,
             " combinations of levels; name the factors to analyse");
  }
  US_CHECK(!design.names.empty(), "all answers are of one condition: there is nothing to compare");
  all_effects(static_cast<int>(design.names.size()));  // throws where there are too many
  return design;
}

/// The answer as a number. Throws Error naming the line where it is outside the scale.
double value_of(const ParticipantAnswers& participant, const StudyAnswer& answer,
                const RatedQuestion& question) {
  if (!question.choices.empty()) {
    const auto at = std::find(question.choices.begin(), question.choices.end(), answer.answer);
    US_CHECK(at != question.choices.end(), place_of(participant, answer), ": \"", excerpt(answer.answer),
             "\" is not an option of the question \"", question.name, "\"");
    return static_cast<double>(at - question.choices.begin());
  }
  double value = 0;
  const bool is_number = parse_number(answer.answer, value);
  US_CHECK(is_number && value >= question.low && value <= question.high, place_of(participant, answer),
           ": \"", excerpt(answer.answer), "\" is outside the scale of the question \"", question.name,
           "\", ", printed("%g to %g", question.low, question.high));
  return value;
}

/// One participant's answers to one question.
struct Given {
  std::vector<std::vector<double>> cells;
  int count = 0, empty = 0;
};

Given given(const ParticipantAnswers& participant, const RatedQuestion& question, const Design& design) {
  Given all;
  all.cells.resize(design.cell_count());
  for (const StudyAnswer& one : participant.answers) {
    if (one.question != question.name) continue;
    if (one.answer.empty()) {
      ++all.empty;
      continue;
    }
    ++all.count;
    all.cells[design.cell_of(one)].push_back(value_of(participant, one, question));
  }
  return all;
}

/// The count that most have; of several, the largest.
int usual_count(const std::vector<std::vector<Given>>& everybody, size_t question) {
  std::map<int, int> who;
  for (const auto& one : everybody) ++who[one[question].count + one[question].empty];
  int usual = 0, most = 0;
  for (const auto& [count, people] : who)
    if (people >= most) usual = count, most = people;
  return usual;
}

/// A sentence on what is missing, empty where nothing is.
std::string missing(const Given& given, int usual, const RatedQuestion& question, const Design& design) {
  const std::string to = " to \"" + question.name + "\"";
  if (given.count < usual) return printed("has %d of %d answers", given.count, usual) + to;
  const auto cell =
      std::find_if(given.cells.begin(), given.cells.end(), [](const auto& one) { return one.empty(); });
  if (cell == given.cells.end()) return {};
  const Effect whole = (1u << design.names.size()) - 1;
  return "has no answer" + to + " for " +
         design.level_name(static_cast<int>(cell - given.cells.begin()), whole);
}

/// What would have been right.
std::string right_answer(const StudyAnswers& answers, const StudyAnswer& answer,
                         const AttentionCheck& check) {
  if (!check.right.empty()) return check.right;
  const std::string& level = answer.levels[column_of(answers, check.column)];
  const auto named = check.right_of_level.find(level);
  return named == check.right_of_level.end() ? level : named->second;
}

/// Share of right answers to all questions of attention; NaN where none was asked.
double attention_of(const StudyAnswers& answers, const ParticipantAnswers& participant,
                    const std::vector<AttentionCheck>& checks) {
  int asked = 0, right = 0;
  for (const StudyAnswer& one : participant.answers)
    for (const AttentionCheck& check : checks) {
      if (one.question != check.question) continue;
      ++asked;
      if (lower_case(one.answer) == lower_case(right_answer(answers, one, check))) ++right;
    }
  return asked > 0 ? static_cast<double>(right) / asked : kUnknown;
}

LevelSummary summary_of(std::string level, const std::vector<double>& values) {
  LevelSummary one;
  one.level = std::move(level);
  one.count = static_cast<int>(values.size());
  one.median = percentile(values, 50);
  one.first_quartile = percentile(values, 25);
  one.third_quartile = percentile(values, 75);
  for (const double value : values) one.mean += value / one.count;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  one.least = one.high_whisker = *least, one.most = one.low_whisker = *most;
  const double reach = 1.5 * (one.third_quartile - one.first_quartile);
  for (const double value : values) {
    if (value >= one.first_quartile - reach) one.low_whisker = std::min(one.low_whisker, value);
    if (value <= one.third_quartile + reach) one.high_whisker = std::max(one.high_whisker, value);
  }
  return one;
}

/// All that the tests of one question need.
struct QuestionData {
  FactorialData data;
  std::vector<std::vector<double>> cells;  ///< single answers of all participants
};

QuestionData data_of(const std::vector<const Given*>& kept, const Design& design) {
  QuestionData all;
  all.data.levels = design.counts;
  all.data.values.resize(ssize(kept), design.cell_count());
  all.cells.resize(design.cell_count());
  for (size_t i = 0; i < kept.size(); ++i)
    for (size_t c = 0; c < all.cells.size(); ++c) {
      const auto& values = kept[i]->cells[c];
      double sum = 0;
      for (const double value : values) sum += value;
      all.data.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
          sum / static_cast<double>(values.size());
      all.cells[c].insert(all.cells[c].end(), values.begin(), values.end());
    }
  return all;
}

std::vector<LevelSummary> summaries(const QuestionData& question, const Design& design, Effect effect,
                                    const std::vector<std::string>& levels) {
  std::map<std::string, std::vector<double>> values;
  for (size_t c = 0; c < question.cells.size(); ++c) {
    auto& all = values[design.level_name(static_cast<int>(c), effect)];
    all.insert(all.end(), question.cells[c].begin(), question.cells[c].end());
  }
  std::vector<LevelSummary> list;
  list.reserve(levels.size());
  for (const std::string& level : levels) list.push_back(summary_of(level, values.at(level)));
  return list;
}

std::vector<std::string> level_names(const Design& design, Effect effect) {
  std::vector<std::string> names;  // in the order of the cells, as collapsed() has them
  std::set<std::string> seen;
  for (int cell = 0; cell < design.cell_count(); ++cell) {
    std::string name = design.level_name(cell, effect);
    if (seen.insert(name).second) names.push_back(std::move(name));
  }
  return names;
}

EffectReport effect_report(const QuestionData& question, const Design& design, Effect effect,
                           int most_levels) {
  EffectReport report;
  report.name = design.effect_name(effect);
  report.levels = level_names(design, effect);
  report.art = art_anova(question.data, effect);
  if (ssize(report.levels) <= most_levels || (effect & (effect - 1)) == 0) {
    report.contrasts = art_contrasts(question.data, effect);
    report.summaries = summaries(question, design, effect, report.levels);
  }
  if ((effect & (effect - 1)) == 0) {
    const FactorialData means = collapsed(question.data, effect);
    report.plain = within_anova(means, 1);
    report.tukey = tukey_comparisons(means);
  }
  return report;
}

/// Two-sided, of as many heads and tails.
double sign_test(int heads, int tails) {
  const int all = heads + tails;
  if (all == 0) return 1;
  const boost::math::binomial_distribution<double> fair(all, 0.5);
  return std::min(1.0, 2 * boost::math::cdf(fair, std::min(heads, tails)));
}

/// Holm's step-down: the least p counts for all pairs, the next for one less, and none is less than one
/// before.
void adjust(std::vector<PairPreference>& pairs) {
  std::vector<PairPreference*> by_p;
  by_p.reserve(pairs.size());
  for (PairPreference& pair : pairs) by_p.push_back(&pair);
  std::stable_sort(by_p.begin(), by_p.end(), [](auto* a, auto* b) { return a->p < b->p; });
  double so_far = 0;
  for (size_t i = 0; i < by_p.size(); ++i) {
    so_far = std::max(so_far, std::min(1.0, static_cast<double>(by_p.size() - i) * by_p[i]->p));
    by_p[i]->p = so_far;
  }
}

/// Cells are pairs, a value of 1 is a choice of the second condition.
PairPreference preference_of(const std::vector<const Given*>& kept, size_t cell, const std::string& level) {
  const size_t at = level.find(kBetween);
  PairPreference pair{level.substr(0, at), level.substr(at + 1)};
  for (const Given* one : kept) {
    const auto& values = one->cells[cell];
    const int all = static_cast<int>(values.size());
    const int second = static_cast<int>(std::count(values.begin(), values.end(), 1.0)), first = all - second;
    pair.answers_a += first, pair.answers_b += second;
    pair.participants_a += first > second, pair.participants_b += second > first;
  }
  pair.p = sign_test(pair.participants_a, pair.participants_b);
  return pair;
}

PreferenceReport preference_report(const std::vector<const Given*>& kept, const Design& design,
                                   const std::string& name) {
  PreferenceReport report;
  report.name = name;
  std::map<std::string, std::pair<int, int>> chosen;  // how often, of how many
  for (size_t cell = 0; cell < design.levels[0].size(); ++cell) {
    const PairPreference pair = preference_of(kept, cell, design.levels[0][cell]);
    const int all = pair.answers_a + pair.answers_b;
    for (const auto& [condition, count] :
         {std::pair(pair.a, pair.answers_a), std::pair(pair.b, pair.answers_b)})
      chosen[condition].first += count, chosen[condition].second += all;
    report.pairs.push_back(pair);
  }
  adjust(report.pairs);
  for (const auto& [condition, count] : chosen)
    report.shares.emplace_back(condition, static_cast<double>(count.first) / count.second);
  return report;
}

ParticipantReport participant_report(const ParticipantAnswers& participant, const std::vector<Given>& given) {
  ParticipantReport report;
  report.participant = participant.participant;
  report.answers = static_cast<int>(participant.answers.size());
  std::vector<double> times;
  for (const StudyAnswer& one : participant.answers) {
    report.replays += one.replays;
    if (!std::isnan(one.rt_ms)) times.push_back(one.rt_ms);
  }
  report.median_rt_ms = times.empty() ? kUnknown : percentile(times, 50);
  for (const Given& one : given) {
    std::vector<double> values;
    for (const auto& cell : one.cells) values.insert(values.end(), cell.begin(), cell.end());
    report.medians.push_back(values.empty() ? kUnknown : percentile(values, 50));
  }
  return report;
}

/// Why a participant is excluded; empty: not at all.
std::string reason_against(const ParticipantReport& participant, const AnalysisOptions& options,
                           const std::string& missing) {
  if (options.attention.empty()) return missing;
  const double share = participant.attention, least = options.least_attention;
  if (std::isnan(share)) return "has no answer to \"" + options.attention.front().question + "\"";
  if (share < least || (options.must_exceed && share <= least))
    return printed("answered %.0f %% of the attention questions right, %s %.0f %%", 100 * share,
                   options.must_exceed ? "not more than" : "less than", 100 * least);
  return missing;
}

void check_left(const StudyReport& report) {
  if (report.analysed >= 2) return;
  const std::string why =
      report.excluded.empty()
          ? ""
          : printed("; %zu excluded, the first because %s %s", report.excluded.size(),
                    report.excluded.front().participant.c_str(), report.excluded.front().reason.c_str());
  throw Error(
      (report.analysed == 1 ? "there are answers of one participant only" : "no participant is left") +
      std::string(": statistics need at least two") + why);
}

}  // namespace

std::string paired(const std::string& first, const std::string& second) {
  return first + kBetween + second;
}

StudyReport analyse(const StudyAnswers& all_answers, const AnalysisOptions& options) {
  const StudyAnswers answers = without_practice(all_answers);
  const std::vector<RatedQuestion> questions = questions_of(answers, options);
  const Design design = design_of(answers, questions, options.factors, options.pairs ? 1 : 2);
  std::vector<std::vector<Given>> everybody;  // [participant][question]
  for (const auto& participant : answers.participants) {
    everybody.emplace_back();
    for (const RatedQuestion& one : questions) everybody.back().push_back(given(participant, one, design));
  }

  StudyReport report;
  report.study = options.study;
  report.factors = design.names;
  std::vector<size_t> kept;
  for (size_t i = 0; i < everybody.size(); ++i) {
    std::string lacking;
    for (size_t q = 0; q < questions.size() && lacking.empty(); ++q)
      lacking = missing(everybody[i][q], usual_count(everybody, q), questions[q], design);
    ParticipantReport one = participant_report(answers.participants[i], everybody[i]);
    one.attention = attention_of(answers, answers.participants[i], options.attention);
    const std::string reason = reason_against(one, options, lacking);
    one.is_excluded = !reason.empty();
    if (one.is_excluded) report.excluded.push_back({one.participant, reason});
    if (!one.is_excluded) kept.push_back(i);
    report.participants.push_back(std::move(one));
  }
  report.analysed = static_cast<int>(kept.size());
  check_left(report);

  for (size_t q = 0; q < questions.size(); ++q) {
    std::vector<const Given*> of_question;
    of_question.reserve(kept.size());
    for (const size_t i : kept) of_question.push_back(&everybody[i][q]);
    if (options.pairs) {
      report.preferences.push_back(preference_report(of_question, design, questions[q].name));
      continue;
    }
    const QuestionData data = data_of(of_question, design);
    QuestionReport one;
    one.name = questions[q].name;
    one.agreement = intraclass_correlation(data.data.values);
    for (const Effect effect : all_effects(static_cast<int>(design.names.size())))
      one.effects.push_back(effect_report(data, design, effect, options.most_contrast_levels));
    report.questions.push_back(std::move(one));
  }
  return report;
}

}  // namespace understudy::app
