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
    const auto at = std::find(answers.factors.begin(), answers.factors.end(), factor);
    US_CHECK(at != answers.factors.end(), "the answers have no column \"", factor, "\"");
    const auto column = static_cast<size_t>(at - answers.factors.begin());
    for (const ParticipantAnswers& participant : answers.participants)
      for (const StudyAnswer& one : participant.answers) {
        check_known(questions, one.question, "question", place_of(participant, one));
        check_known(levels, one.levels[column], factor.c_str(), place_of(participant, one));
      }
  }
}

}  // namespace

AnalysisOptions analysis_options(const Study& study) {
  US_CHECK(study.layout.results == TrialResults::One,
           "the trials of this study show two results; only ratings of one are analysed");
  AnalysisOptions options;
  bool is_whole = study.plan.trials_per_participant == 0;
  for (const StudyQuestion& question : study.questions) {
    if (question.kind == QuestionKind::Attention) {
      options.attention.push_back(attention_check(question, study));
      continue;
    }
    if (question.kind == QuestionKind::Choice && question.options.size() > 2) continue;
    is_whole = is_whole && question.every == 1;
    options.questions.push_back(rated(question));
  }
  US_CHECK(!options.questions.empty(), "the study asks nothing that can be compared");
  for (const auto& [name, levels] : factors_of(study))
    if (name == "condition" || (is_whole && levels.size() >= 2)) options.factors.push_back(name);
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
  return answers;
}

}  // namespace understudy::app
