#include "app/study/study_analysis.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/study/trials.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const Named& one : list) names.push_back(one.name);
  return names;
}

/// Columns of the answers and the levels that they may have.
std::vector<std::pair<std::string, std::vector<std::string>>> factors_of(const Study& study) {
  return {{"condition", names_of(study.conditions)},
          {"motion", names_of(study.motions)},
          {"target", names_of(study.targets)}};
}

RatedQuestion rated(const StudyQuestion& question) {
  RatedQuestion one{question.name, 1, static_cast<double>(question.points), {}};
  if (question.kind == QuestionKind::Choice) one.choices = question.options;
  return one;
}

AttentionCheck attention_check(const StudyQuestion& question, const Study& study) {
  AttentionCheck check{question.name, question.right, "motion", {}};
  for (const StudyMotion& motion : study.motions)
    check.right_of_level[motion.name] = right_answer(question, motion);
  return check;
}

void check_known(const std::vector<std::string>& known, const std::string& name, const char* what,
                 const std::string& place) {
  US_CHECK(std::find(known.begin(), known.end(), name) != known.end(), place, ": the study has no ", what,
           " \"", excerpt(name), "\"");
}

void check_answers(const StudyAnswers& answers, const Study& study) {
  const std::vector<std::string> questions = names_of(study.questions);
  for (const auto& [factor, levels] : factors_of(study)) {
    const size_t column = column_of(answers, factor);
    for (const ParticipantAnswers& participant : answers.participants)
      for (const StudyAnswer& one : participant.answers) {
        check_known(questions, one.question, "question", place_of(participant, one));
        check_known(levels, one.levels[column], factor.c_str(), place_of(participant, one));
      }
  }
}

constexpr const char *kFirst = "first", *kSecond = "second";

bool shows_pairs(const Study& study) {
  return study.layout.results == TrialResults::Pair;
}

bool is_compared(const StudyQuestion& question, const Study& study) {
  if (question.kind == QuestionKind::Likert) return !shows_pairs(study);
  return question.kind == QuestionKind::Choice && question.options.size() == 2;
}

/// The conditions alone, unless everybody answers everything in all of the design.
std::vector<std::string> compared_factors(const Study& study, bool is_whole) {
  std::vector<std::string> factors;
  for (const auto& [name, levels] : factors_of(study))
    if (name == "condition" || (is_whole && levels.size() >= 2)) factors.push_back(name);
  return factors;
}

/// What an answer about the left or the right result says of the two in the study's order.
void name_choice(StudyAnswer& answer, const Study& study, const std::string& left, const std::string& right) {
  const std::vector<std::string> names = names_of(study.conditions);
  const bool is_left_first =
      std::find(names.begin(), names.end(), left) < std::find(names.begin(), names.end(), right);
  answer.levels.push_back(is_left_first ? paired(left, right) : paired(right, left));
  for (const StudyQuestion& question : study.questions) {
    if (question.name != answer.question || !is_compared(question, study)) continue;
    for (const bool is_left : {true, false})
      if (answer.answer == question.options[is_left ? 0 : 1])
        return void(answer.answer = is_left == is_left_first ? kFirst : kSecond);
  }
}

StudyAnswers with_pairs(StudyAnswers answers, const Study& study) {
  const size_t condition = column_of(answers, "condition"), other = column_of(answers, "other");
  const std::vector<std::string> conditions = names_of(study.conditions);
  answers.factors.emplace_back(kPairFactor);
  for (ParticipantAnswers& participant : answers.participants)
    for (StudyAnswer& one : participant.answers) {
      check_known(conditions, one.levels[other], "condition", place_of(participant, one));
      name_choice(one, study, one.levels[condition], one.levels[other]);
    }
  return answers;
}

}  // namespace

AnalysisOptions analysis_options(const Study& study) {
  AnalysisOptions options;
  options.study = study.name;
  options.pairs = shows_pairs(study);
  bool is_whole = study.plan.trials_per_participant == 0;
  for (const StudyQuestion& question : study.questions) {
    if (question.kind == QuestionKind::Attention)
      options.attention.push_back(attention_check(question, study));
    if (!is_compared(question, study)) continue;
    is_whole = is_whole && question.every == 1;
    options.questions.push_back(rated(question));
    if (options.pairs) options.questions.back().choices = {kFirst, kSecond};
  }
  US_CHECK(!options.questions.empty(), "the study asks nothing that can be compared");
  options.factors = options.pairs ? std::vector<std::string>{kPairFactor} : compared_factors(study, is_whole);
  options.least_attention = static_cast<double>(study.plan.least_right);
  options.must_exceed = study.plan.must_exceed;
  return options;
}

void check_design(const std::string& path, const std::string& design, const Study& study,
                  const std::string& folder) {
  if (design.empty()) return;
  std::string changes;
  const std::string problem = failure_of([&] { changes = changes_since(design, study, folder); });
  US_CHECK(problem.empty(), path, ": line 2: ", problem);
  US_CHECK(changes.empty(), path, ": these answers are not to this study; it has changed since: ", changes);
}

StudyAnswers counted_answers(StudyAnswers answers, const Study& study, const std::string& folder) {
  for (const ParticipantAnswers& one : answers.participants)
    check_design(one.path, one.design, study, folder);
  check_answers(answers, study);
  for (ParticipantAnswers& participant : answers.participants) {
    std::set<std::string> practice;
    for (const Trial& trial : trials_of(study, participant.participant))
      if (trial.is_practice) practice.insert(trial.id);
    auto& list = participant.answers;
    list.erase(std::remove_if(list.begin(), list.end(),
                              [&](const StudyAnswer& one) { return practice.count(one.trial) > 0; }),
               list.end());
  }
  return shows_pairs(study) ? with_pairs(std::move(answers), study) : answers;
}

}  // namespace understudy::app
