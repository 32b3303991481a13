#include "retarget/metrics/scene_score.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

Joints joints_at(float x) {
  Joints joints;
  for (int j = 0; j < kJointCount; ++j) joints.row(j) << x, 0.1f * static_cast<float>(j), 0;
  return joints;
}

/// Two people of 40 points each, 20 points of ground, 10 that are anybody's.
TruePeople two_people() {
  TruePeople truth;
  truth.owners.assign(40, 0);
  truth.owners.resize(80, 1);
  truth.owners.resize(100, kNobodysPoint);
  truth.owners.resize(110, kUndecidedPoint);
  for (const float x : {0.0f, 2.0f}) truth.people.push_back({joints_at(x), SeenJoints::Ones(), false});
  return truth;
}

/// The truth with ids of its own; anybody's points go to the ground.
PredictedPeople as_it_is(const TruePeople& truth, int first_id = 7, int second_id = 3) {
  PredictedPeople answer;
  for (const int owner : truth.owners)
    answer.owners.push_back(owner == 0 ? first_id : owner == 1 ? second_id : kNobodysPoint);
  answer.people = {{first_id, truth.people[0].joints}, {second_id, truth.people[1].joints}};
  return answer;
}

std::map<std::string, double> figures(const PredictedPeople& answer, const TruePeople& truth) {
  SceneScore score;
  score.push(answer, truth);
  return score.figures();
}

TEST(BestPairs, HaveTheGreatestSumNotTheGreatestFirst) {
  RowMatrix gain(2, 3);
  gain << 10, 9, 0, 9, 1, 0;
  EXPECT_EQ(best_pairs(gain), (std::vector<int>{1, 0}));
  gain << 10, 0, 0, 9, 0, 0;  // one column for two rows
  EXPECT_EQ(best_pairs(gain), (std::vector<int>{0, -1}));
  EXPECT_TRUE(best_pairs(RowMatrix::Zero(0, 2)).empty());
  EXPECT_THROW(best_pairs(RowMatrix::Zero(13, 2)), Error);
}

TEST(SceneScore, FindsNoFaultWithTheTruth) {
  auto found = figures(as_it_is(two_people()), two_people());
  EXPECT_EQ(found["points_owner_right"], 1);
  EXPECT_EQ(found["people_mm"], 0);
  for (const char* key : {"identities_exchanged", "people_missed", "people_invented"}) {
    ASSERT_TRUE(found.count(key)) << key;
    EXPECT_EQ(found[key], 0) << key;
  }
  EXPECT_FALSE(found.count("people_touching_mm"));
}

TEST(SceneScore, CountsPointsOfAnotherAndOfTheGround) {
  PredictedPeople answer = as_it_is(two_people());
  for (int i = 0; i < 8; ++i) answer.owners[i] = 3;    // the other's
  for (int i = 80; i < 84; ++i) answer.owners[i] = 7;  // ground as the first one's
  for (int i = 60; i < 63; ++i) answer.owners[i] = kNobodysPoint;
  for (int i = 100; i < 110; ++i) answer.owners[i] = 7;  // nobody minds
  EXPECT_DOUBLE_EQ(figures(answer, two_people())["points_owner_right"], 0.85);
}

TEST(SceneScore, CountsExchangedIdentitiesAndANewOneAfterAnAbsence) {
  const TruePeople truth = two_people();
  TruePeople empty = truth;
  for (int i = 0; i < 40; ++i) empty.owners[i] = kNobodysPoint;  // the first has left
  empty.people[0].seen.setZero();
  SceneScore score;
  score.push(as_it_is(truth, 1, 2), truth);
  EXPECT_EQ(score.figures()["identities_exchanged"], 0);
  score.push(as_it_is(truth, 2, 1), truth);  // both
  EXPECT_EQ(score.figures()["identities_exchanged"], 2);
  PredictedPeople one = as_it_is(empty, 2, 1);
  one.people.erase(one.people.begin());
  score.push(one, empty);
  score.push(as_it_is(truth, 9, 1), truth);  // comes back as somebody else
  auto found = score.figures();
  EXPECT_EQ(found["identities_exchanged"], 3);
  EXPECT_EQ(found["people_missed"], 0);
  EXPECT_EQ(found["points_owner_right"], 1);
}

TEST(SceneScore, TwoPeopleTakenForOneAreOneMissed) {
  const TruePeople truth = two_people();
  PredictedPeople answer = as_it_is(truth, 4, 4);
  answer.people.pop_back();
  answer.people[0].joints = joints_at(0.05f);
  auto found = figures(answer, truth);
  EXPECT_EQ(found["people_missed"], 0.5);
  EXPECT_DOUBLE_EQ(found["points_owner_right"], 0.6);
  EXPECT_NEAR(found["people_mm"], 50, 1e-3);  // of the one who was found
}

TEST(SceneScore, PeopleWhoAreThingsAreInvented) {
  PredictedPeople answer = as_it_is(two_people());
  answer.people.push_back({5, joints_at(1)});
  for (int i = 80; i < 100; ++i) answer.owners[i] = 5;
  auto found = figures(answer, two_people());
  EXPECT_EQ(found["people_invented"], 1);
  EXPECT_DOUBLE_EQ(found["points_owner_right"], 0.8);
}

TEST(SceneScore, WhoIsHardlySeenIsNotMissedAndTheirUnseenJointsDoNotCount) {
  TruePeople truth = two_people();
  truth.people[1].seen.tail<14>().setZero();
  PredictedPeople answer = as_it_is(truth);
  answer.people[1].joints.bottomRows<14>().array() += 5;
  EXPECT_EQ(figures(answer, truth)["people_mm"], 0);
  answer.people.pop_back();
  EXPECT_EQ(figures(answer, truth)["people_missed"], 0);
}

TEST(SceneScore, SetsPeopleBesideThemselvesAlone) {
  TruePeople truth = two_people();
  truth.people[1].touches = true;
  PredictedPeople answer = as_it_is(truth);
  answer.people[0].joints = joints_at(0.02f);
  answer.people[1].joints = joints_at(2.06f);
  SceneScore score;
  score.push(answer, truth);
  score.push_alone(0, 0, joints_at(0.02f), truth.people[0]);
  score.push_alone(0, 1, joints_at(2.03f), truth.people[1]);
  auto found = score.figures();
  EXPECT_NEAR(found["people_mm"], 40, 1e-3);
  EXPECT_NEAR(found["people_alone_mm"], 25, 1e-3);
  EXPECT_NEAR(found["people_over_alone"], 1.6, 1e-5);
  EXPECT_NEAR(found["people_touching_over_alone"], 2, 1e-5);
  EXPECT_THROW(score.push_alone(1, 0, joints_at(0), truth.people[0]), Error);
}

TEST(SceneScore, RefusesOwnersOfAnotherScan) {
  PredictedPeople answer = as_it_is(two_people());
  answer.owners.pop_back();
  EXPECT_THROW(figures(answer, two_people()), Error);
}

}  // namespace
}  // namespace understudy
