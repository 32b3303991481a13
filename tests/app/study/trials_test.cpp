#include "app/study/trials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/study/presets.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "tests/app/study/made_study.hpp"

namespace understudy::app {
namespace {

using tests::made_study;

/// Without a participant's practice.
std::vector<Trial> main_trials(const Study& study, const std::string& participant) {
  std::vector<Trial> trials = trials_of(study, participant);
  trials.erase(trials.begin(), trials.begin() + study.plan.practice);
  return trials;
}

std::vector<std::string> ids(const std::vector<Trial>& trials) {
  std::vector<std::string> all;
  for (const Trial& trial : trials) all.push_back(trial.id);
  return all;
}

std::vector<std::string> sorted_ids(const std::vector<Trial>& trials) {
  std::vector<std::string> all = ids(trials);
  std::sort(all.begin(), all.end());
  return all;
}

/// Whether all counts are the same, and there are so many.
template <class Key>
bool all_equal(const std::map<Key, int>& counts, size_t size) {
  return counts.size() == size && std::all_of(counts.begin(), counts.end(), [&](const auto& one) {
           return one.second == counts.begin()->second;
         });
}

TEST(LatinSquare, LetsEachFollowEachOtherEquallyOften) {
  for (int count = 2; count <= 9; ++count) {
    const auto square = balanced_latin_square(count);
    EXPECT_EQ(square.size(), static_cast<size_t>(count % 2 == 0 ? count : 2 * count));
    std::map<std::pair<int, int>, int> follows, at;
    for (const auto& row : square) {
      EXPECT_EQ(std::set<int>(row.begin(), row.end()).size(), static_cast<size_t>(count));
      for (int column = 0; column < count; ++column) ++at[{column, row[column]}];
      for (int column = 1; column < count; ++column) ++follows[{row[column - 1], row[column]}];
    }
    EXPECT_TRUE(all_equal(follows, static_cast<size_t>(count) * (count - 1))) << count;
    EXPECT_TRUE(all_equal(at, static_cast<size_t>(count) * count)) << count;
  }
  EXPECT_NE(failure_of([] { balanced_latin_square(1); }), "");
}

TEST(Trials, AreEveryCombinationOnce) {
  Study study = made_study("/a");
  study.plan.repetitions = 2;
  const std::vector<Trial> trials = all_trials(study);
  ASSERT_EQ(trials.size(), 3u * 2 * 3 * 2);
  std::set<std::vector<int>> seen;
  for (const Trial& trial : trials)
    seen.insert({trial.condition, trial.motion, trial.target, trial.repetition});
  EXPECT_EQ(seen.size(), trials.size());
  EXPECT_EQ(trials[0].id, "t001");
  EXPECT_EQ(trials[35].id, "t036");
  EXPECT_EQ(trials[35].repetition, 2);
}

TEST(Trials, OfThePresetsAreAsManyAsInThePapers) {
  EXPECT_EQ(all_trials(study_preset("rekik").make("/samples")).size(), 45u);
  EXPECT_EQ(all_trials(study_preset("dong").make("/samples")).size(), 50u);
}

TEST(Trials, OfAParticipantAreAlwaysInTheSameOrder) {
  const Study study = made_study("/a");
  EXPECT_EQ(ids(trials_of(study, "7")), ids(trials_of(study, "7")));
  EXPECT_NE(ids(trials_of(study, "7")), ids(trials_of(study, "8")));
  Study other = study;
  other.plan.seed = 2;
  EXPECT_NE(ids(trials_of(study, "7")), ids(trials_of(other, "7")));
  EXPECT_EQ(sorted_ids(main_trials(study, "7")), sorted_ids(all_trials(study)));
  EXPECT_EQ(failure_of([&] { trials_of(study, ""); }), "a participant needs a name or a number");
  // What any machine must give.
  const std::vector<std::string> order = ids(main_trials(study, "7"));
  EXPECT_EQ(std::vector<std::string>(order.begin(), order.begin() + 6),
            (std::vector<std::string>{"t008", "t015", "t003", "t016", "t007", "t002"}));
}

TEST(Trials, OfTheLatinSquareAreBalancedOverParticipants) {
  Study study = made_study("/a");
  study.plan.order = TrialOrder::LatinSquare;
  std::map<std::pair<int, int>, int> follows, first;
  for (int participant = 1; participant <= 6; ++participant) {
    const std::vector<Trial> trials = main_trials(study, "P" + std::to_string(participant));
    EXPECT_EQ(sorted_ids(trials), sorted_ids(all_trials(study)));
    for (size_t block = 0; block < trials.size(); block += 3) {
      ++first[{0, trials[block].condition}];
      for (size_t i = block + 1; i < block + 3; ++i)
        ++follows[{trials[i - 1].condition, trials[i].condition}];
    }
  }
  EXPECT_TRUE(all_equal(follows, 6));
  EXPECT_TRUE(all_equal(first, 3));
}

TEST(Trials, OfABalancedSubsetAreSharedOutEqually) {
  Study study = made_study("/a");
  study.plan.trials_per_participant = 9;
  for (const TrialOrder order : {TrialOrder::Random, TrialOrder::LatinSquare}) {
    study.plan.order = order;
    std::map<std::string, int> seen;
    for (int participant = 1; participant <= 4; ++participant) {
      std::map<int, int> conditions, targets;
      for (const Trial& trial : main_trials(study, std::to_string(participant))) {
        ++seen[trial.id], ++conditions[trial.condition], ++targets[trial.target];
      }
      EXPECT_TRUE(all_equal(conditions, 3));
      EXPECT_EQ(conditions[0], 3);
      EXPECT_GE(targets.size(), 2u);
    }
    EXPECT_TRUE(all_equal(seen, 18));
  }
  study.plan.trials_per_participant = 10;
  EXPECT_NE(failure_of([&] { trials_of(study, "1"); }).find("it must divide by 3"), std::string::npos);
  study.plan.trials_per_participant = 21;
  EXPECT_EQ(failure_of([&] { all_trials(study); }), "trials_per_participant is 21, the design has 18");
}

TEST(Trials, BeginWithPractice) {
  Study study = made_study("/a");
  study.plan.practice = 4;
  const std::vector<Trial> trials = trials_of(study, "1");
  ASSERT_EQ(trials.size(), 22u);
  std::set<int> conditions;
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(trials[i].is_practice);
    EXPECT_EQ(trials[i].id, "p0" + std::to_string(i + 1));
    EXPECT_EQ(trials[i].questions.size(), 3u);
    conditions.insert(trials[i].condition);
  }
  EXPECT_EQ(conditions.size(), 3u);
  EXPECT_FALSE(trials[4].is_practice);
}

TEST(Trials, AskForAttentionOnceInEveryStretch) {
  const Study study = made_study("/a");  // one of four
  std::set<size_t> places;
  for (int participant = 1; participant <= 20; ++participant) {
    const std::vector<Trial> trials = main_trials(study, std::to_string(participant));
    for (size_t first = 0; first < trials.size(); first += 4) {
      int asked = 0;
      for (size_t i = first; i < std::min(first + 4, trials.size()); ++i)
        if (trials[i].questions.back() == 2) ++asked, places.insert(i - first);
      EXPECT_EQ(asked, 1);
    }
    for (const Trial& trial : trials) EXPECT_EQ(trial.questions[1], 1);  // the others always
  }
  EXPECT_EQ(places.size(), 4u);  // it cannot be foreseen
}

TEST(Trials, OfPairsChangeSides) {
  Study study = made_study("/a");
  study.layout.results = TrialResults::Pair;
  study.plan.repetitions = 2;
  for (const TrialOrder order : {TrialOrder::Random, TrialOrder::LatinSquare}) {
    study.plan.order = order;
    std::map<std::pair<int, int>, int> pairs;
    for (const Trial& trial : main_trials(study, "3")) ++pairs[{trial.condition, trial.other}];
    EXPECT_TRUE(all_equal(pairs, 6));
  }
}

TEST(Trials, TakeTheirTime) {
  Study study = made_study("/a");
  // 18 trials of 10 s, 2 questions of 5 s and a quarter of one; 2 of practice with 3 questions
  EXPECT_NEAR(minutes_of(study), (18 * (10 + 10 + 1.25) + 2 * 25) / 60, 1e-9);
  study.plan.break_every = 6;
  EXPECT_NEAR(minutes_of(study), (18 * (10 + 10 + 1.25) + 2 * 25 + 2 * 60) / 60, 1e-9);
}

TEST(Trials, HaveClipsWhoseNamesTellNothing) {
  Study study = made_study("/a");
  study.plan.repetitions = 2;
  std::map<std::string, int> names;
  for (const Trial& trial : all_trials(study)) ++names[clip_name(study, trial)];
  EXPECT_TRUE(all_equal(names, 18));
  EXPECT_EQ(names.begin()->first.size(), 16u);
  EXPECT_EQ(names.begin()->first.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(TrialExports, QuoteWhatCsvMust) {
  Study study = made_study("/a");
  study.conditions[0].name = "ours, \"new\"";
  const std::vector<Trial> trials = trials_of(study, "1");
  const std::vector<std::string> lines = split(trials_as_csv(study, trials), '\n');
  ASSERT_EQ(lines.size(), trials.size() + 1);
  EXPECT_EQ(lines[0], "position,trial,practice,condition,other,motion,target,repetition,clip,questions");
  const auto ours =
      std::find_if(trials.begin(), trials.end(), [](const Trial& one) { return one.condition == 0; });
  const std::string& line = lines[static_cast<size_t>(ours - trials.begin()) + 1];
  EXPECT_NE(line.find(",\"ours, \"\"new\"\"\",,"), std::string::npos) << line;
  EXPECT_EQ(line.substr(0, line.find(',')), std::to_string(ours - trials.begin() + 1));
}

TEST(TrialExports, AlignTheTable) {
  const Study study = made_study("/a");
  const std::vector<std::string> lines = split(trials_as_table(study, all_trials(study)), '\n');
  ASSERT_EQ(lines.size(), 19u);
  const size_t at = lines[0].find("motion");
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::string motion = lines[i].substr(at, 4);
    EXPECT_TRUE(motion == "walk" || motion == "jump") << lines[i];
  }
  EXPECT_EQ(lines[0].find("other"), std::string::npos);
}

TEST(TrialExports, GivePsychoPyAColumnForEachPartOfAQuestion) {
  const Study study = made_study("/a");
  const std::vector<Trial> trials = trials_of(study, "1");
  const std::vector<std::string> lines = split(trials_for_psychopy(study, trials), '\n');
  ASSERT_EQ(lines.size(), trials.size() + 1);
  const std::vector<std::string> names = split(lines[0], ',');
  EXPECT_EQ(names.size(), 8u + 3 * 9);
  for (const std::string& name : names)  // they become variables
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"), std::string::npos) << name;
  const size_t ask = static_cast<size_t>(std::find(names.begin(), names.end(), "q3_ask") - names.begin());
  for (size_t i = 0; i < trials.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i + 1], ',');
    ASSERT_EQ(cells.size(), names.size()) << lines[i + 1];
    EXPECT_EQ(cells[2], clip_path(study, trials[i]));
    EXPECT_EQ(cells[ask], trials[i].questions.back() == 2 ? "1" : "0");
    EXPECT_EQ(cells.back(), study.motions[trials[i].motion].name);
  }
}

TEST(TrialExports, GiveJsPsychAVideoAndItsQuestions) {
  const Study study = made_study("/a");
  const std::vector<Trial> trials = trials_of(study, "1");
  const Json json = Json::parse(trials_for_jspsych(study, trials));
  size_t at = 0;
  for (const Trial& trial : trials) {
    const Json& video = json["timeline"][at++];
    EXPECT_EQ(video["type"], "video-keyboard-response");
    EXPECT_EQ(video["stimulus"][0], clip_path(study, trial));
    EXPECT_EQ(video["data"]["condition"], study.conditions[trial.condition].name);
    for (const int q : trial.questions) {
      const Json& asked = json["timeline"][at++];
      EXPECT_EQ(asked["type"], q == 0 ? "survey-likert" : "survey-multi-choice");
      EXPECT_EQ(asked["questions"][0]["prompt"], study.questions[q].text);
      EXPECT_EQ(asked["questions"][0][q == 0 ? "labels" : "options"].size(), q == 0 ? 7u : 2u);
      EXPECT_EQ(asked["data"].contains("right"), q == 2);
      EXPECT_EQ(asked["data"]["trial"], trial.id);
    }
  }
  EXPECT_EQ(at, json["timeline"].size());
}

TEST(TrialExports, GiveJsPsychItsBreaksAfterTrialsThatCount) {
  Study study = made_study("/a");
  study.plan.break_every = 6;
  const std::vector<Trial> trials = trials_of(study, "1");
  const Json json = Json::parse(trials_for_jspsych(study, trials));
  std::vector<int> breaks;
  int clips = 0;
  for (const Json& one : json["timeline"]) {
    if (one["data"]["part"] == "clip") ++clips;
    if (one["data"]["part"] == "break") breaks.push_back(clips - study.plan.practice);
  }
  EXPECT_EQ(breaks, (std::vector<int>{6, 12}));  // none after the last
}

}  // namespace
}  // namespace understudy::app
