#include "app/study/study_analysis.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "app/study/trials.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "tests/app/study/made_study.hpp"

namespace understudy::app {
namespace {

Study made_study() {
  return tests::made_study("/nowhere");
}

/// Answers of participants who see their trials and like "guest" best; they know what they see.
StudyAnswers answers_to(const Study& study, int participants) {
  StudyAnswers all;
  all.factors = {"practice", "condition", "other", "motion", "target", "repetition"};
  Rng rng(8);
  for (int i = 1; i <= participants; ++i) {
    ParticipantAnswers one{"P" + std::to_string(i), "P" + std::to_string(i) + ".csv", {}};
    for (const Trial& trial : trials_of(study, one.participant))
      for (const int q : trial.questions) {
        const StudyMotion& motion = study.motions[trial.motion];
        const double rating = 3.5 + (trial.condition == 2 ? 1.5 : 0) + rng.normal();
        StudyAnswer answer;
        answer.trial = trial.id, answer.question = study.questions[q].name;
        answer.answer = q == 0   ? std::to_string(std::clamp(static_cast<int>(rating), 1, 7))
                        : q == 1 ? rng.chance(0.5f) ? "Adult" : "Child"
                                 : right_answer(study.questions[q], motion);
        answer.levels = {
            trial.is_practice ? "1" : "0",    study.conditions[trial.condition].name, "", motion.name,
            study.targets[trial.target].name, std::to_string(trial.repetition)};
        answer.line = one.answers.size() + 2;
        one.answers.push_back(answer);
      }
    all.participants.push_back(std::move(one));
  }
  return all;
}

TEST(StudyAnalysis, FollowsTheStudyFile) {
  Study study = made_study();
  study.plan.must_exceed = true;
  const AnalysisOptions options = analysis_options(study);
  EXPECT_EQ(options.factors, (std::vector<std::string>{"condition", "motion", "target"}));
  ASSERT_EQ(options.questions.size(), 2u);
  EXPECT_EQ(options.questions[0].high, 7);
  EXPECT_EQ(options.questions[1].choices, (std::vector<std::string>{"Adult", "Child"}));
  ASSERT_EQ(options.attention.size(), 1u);
  EXPECT_TRUE(options.must_exceed);

  const StudyAnswers answers = answers_to(study, 12);
  const StudyReport report = analyse(counted_answers(answers, study, "/nowhere"), options);
  EXPECT_EQ(report.analysed, 12);
  EXPECT_EQ(report.participants[0].attention, 1);
  EXPECT_LT(report.questions[0].effects[0].art.p, 1e-4);
  EXPECT_EQ(report.questions[0].effects[0].levels, (std::vector<std::string>{"copy", "guest", "no offsets"}));
}

TEST(StudyAnalysis, LeavesPracticeOutByItsTrials) {
  const Study study = made_study();
  StudyAnswers answers = answers_to(study, 3);
  answers.factors[0] = "hand";  // nobody says which trials were practice
  const auto count = [](const StudyAnswers& all) {
    return analyse(all, {{{"natural"}}, {"condition"}, {}}).participants[0].answers;
  };
  const int all = count(answers);
  const StudyAnswers counted = counted_answers(answers, study, "/nowhere");
  EXPECT_LT(count(counted), all);
  for (const StudyAnswer& one : counted.participants[0].answers) EXPECT_EQ(one.trial[0], 't');
}

TEST(StudyAnalysis, KnowsTheActionOfAMotion) {
  Study study = made_study();
  study.motions[1].action = "leap";
  study.questions[2].options = {"walk", "leap"};
  StudyAnswers answers = answers_to(study, 4);
  EXPECT_TRUE(analyse(answers, analysis_options(study)).excluded.empty());
  for (StudyAnswer& one : answers.participants[2].answers)
    if (one.question == "action") one.answer = "jump";
  study.plan.least_right = 0.9f;
  EXPECT_EQ(analyse(answers, analysis_options(study)).excluded.size(), 1u);
}

TEST(StudyAnalysis, OfASubsetComparesTheConditionsAlone) {
  Study study = made_study();
  study.plan.trials_per_participant = 9;
  EXPECT_EQ(analysis_options(study).factors, std::vector<std::string>{"condition"});
  EXPECT_EQ(analyse(answers_to(study, 6), analysis_options(study)).analysed, 6);
}

TEST(StudyAnalysis, RefusesAnswersOfAnotherStudy) {
  const Study study = made_study();
  const auto complaint = [&](const StudyAnswers& answers) {
    return failure_of([&] { counted_answers(answers, study, "/nowhere"); });
  };
  StudyAnswers answers = answers_to(study, 2);
  EXPECT_EQ(complaint(answers), "");
  answers.participants[1].answers[3].levels[1] = "TST";
  EXPECT_EQ(complaint(answers), "P2.csv: line 5: the study has no condition \"TST\"");
  answers = answers_to(study, 2);
  answers.participants[0].answers[0].question = "beauty";
  EXPECT_EQ(complaint(answers), "P1.csv: line 2: the study has no question \"beauty\"");
  answers.factors[4] = "shape";
  answers.participants[0].answers[0].question = "natural";
  EXPECT_EQ(complaint(answers), "the answers have no column \"target\"");
}

/// A study of pairs; so many people answer, and each chooses by `likes` (condition, other: the left one?).
StudyReport report_of_pairs(Study study, int people, const std::function<bool(int, int)>& likes_left) {
  study.layout.results = TrialResults::Pair;
  study.questions[1].options = {"Left", "Right"};
  StudyAnswers all;
  all.factors = {"practice", "condition", "other", "motion", "target", "repetition"};
  for (int i = 1; i <= people; ++i) {
    ParticipantAnswers one{"P" + std::to_string(i), "P" + std::to_string(i) + ".csv", {}};
    for (const Trial& trial : trials_of(study, one.participant)) {
      StudyAnswer answer;
      answer.trial = trial.id, answer.question = "age";
      answer.answer = likes_left(trial.condition, trial.other) ? "Left" : "Right";
      answer.levels = {trial.is_practice ? "1" : "0",      study.conditions[trial.condition].name,
                       study.conditions[trial.other].name, study.motions[trial.motion].name,
                       study.targets[trial.target].name,   "1"};
      one.answers.push_back(answer);
    }
    all.participants.push_back(std::move(one));
  }
  AnalysisOptions options = analysis_options(study);
  options.attention.clear();
  return analyse(counted_answers(all, study, "/nowhere"), options);
}

TEST(StudyAnalysis, OfPairsCountsWhoPrefersWhat) {
  // "guest" always wins, and "copy" over "no offsets".
  const StudyReport report = report_of_pairs(
      made_study(), 10, [&](int left, int right) { return left == 2 || (right != 2 && left == 0); });
  ASSERT_EQ(report.preferences.size(), 1u);
  EXPECT_TRUE(report.questions.empty());
  const PreferenceReport& age = report.preferences[0];
  EXPECT_EQ(age.name, "age");
  ASSERT_EQ(age.pairs.size(), 3u);
  for (const PairPreference& pair : age.pairs) {
    const bool is_guests = pair.b == "guest";
    EXPECT_EQ(pair.answers_a + pair.answers_b, 60);  // 10 people, 2 motions, 3 targets
    EXPECT_EQ(pair.participants_b, is_guests ? 10 : 0) << pair.a << pair.b;
    EXPECT_NEAR(pair.p, 3 * 2 / 1024., 1e-12);  // R: p.adjust(rep(binom.test(10, 10)$p.value, 3), "holm")
  }
  for (const auto& [condition, share] : age.shares)
    EXPECT_EQ(share, condition == "guest" ? 1 : condition == "copy" ? 0.5 : 0) << condition;
}

TEST(StudyAnalysis, OfPairsFindsNothingWhereSidesDecide) {
  const StudyReport report = report_of_pairs(made_study(), 12, [](int, int) { return true; });
  for (const PairPreference& pair : report.preferences[0].pairs) {
    EXPECT_EQ(pair.answers_a, pair.answers_b);  // each is left as often as right
    EXPECT_GT(pair.p, 0.3);
  }
}

TEST(StudyAnalysis, OfPairsNeedsAChoiceOfTwo) {
  Study study = made_study();
  study.layout.results = TrialResults::Pair;
  study.questions.erase(study.questions.begin() + 1);
  EXPECT_EQ(failure_of([&] { analysis_options(study); }), "the study asks nothing that can be compared");
}

}  // namespace
}  // namespace understudy::app
