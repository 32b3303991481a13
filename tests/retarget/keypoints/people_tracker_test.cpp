#include "retarget/keypoints/people_tracker.hpp"

#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

FlatPose walker(float x, float height = 300) {
  return standing({x, 400}, height);
}
std::vector<PersonSighting> sightings(const std::vector<FlatPose>& poses) {
  std::vector<PersonSighting> out;
  for (const FlatPose& pose : poses) out.push_back({std::nullopt, 1, pose});
  return out;
}

TEST(PeopleTracker, OrderInTheFileMeansNothing) {
  PeopleTracker tracker;
  for (int t = 0; t < 10; ++t) {
    const float x = 100 + 5.0f * static_cast<float>(t);
    const std::vector<FlatPose> people =
        t % 2 ? std::vector<FlatPose>{walker(400), walker(x)} : std::vector<FlatPose>{walker(x), walker(400)};
    const std::vector<int> found = tracker.push(sightings(people), kFrame);
    EXPECT_EQ(found, t % 2 ? (std::vector<int>{1, 0}) : (std::vector<int>{0, 1}));
  }
  EXPECT_EQ(tracker.number(0), 1);
}

TEST(PeopleTracker, TwoWhoCrossKeepTheirNames) {
  PeopleTracker tracker;
  for (int t = 0; t <= 100; ++t) {
    const float way = 6.0f * static_cast<float>(t);
    std::vector<PersonSighting> people = sightings({walker(100 + way), walker(700 - way)});
    const bool is_hidden = t >= 46 && t <= 54;  // one is behind the other
    if (is_hidden) people.pop_back();
    const std::vector<int> found = tracker.push(people, kFrame);
    EXPECT_EQ(found[0], 0) << t;
    if (!is_hidden) {
      EXPECT_EQ(found[1], 1) << t;
    }
  }
  EXPECT_EQ(tracker.count(), 2);
}

TEST(PeopleTracker, WhoLeavesAndReturnsIsTheSame) {
  PeopleTracker tracker;
  for (int t = 0; t < 30; ++t)
    tracker.push(sightings({walker(500 + 5.0f * static_cast<float>(t)), walker(100, 120)}), kFrame);
  for (int t = 0; t < 150; ++t) tracker.push(sightings({walker(100, 120)}), kFrame);
  const std::vector<int> back = tracker.push(sightings({walker(100, 120), walker(20)}), kFrame);
  EXPECT_EQ(back, (std::vector<int>{1, 0})) << "five seconds later, on the other side";
}

TEST(PeopleTracker, ASmallerNewcomerIsSomebodyElse) {
  PeopleTracker tracker;
  for (int t = 0; t < 30; ++t) tracker.push(sightings({walker(500)}), kFrame);
  for (int t = 0; t < 90; ++t) tracker.push({}, kFrame);
  EXPECT_EQ(tracker.push(sightings({walker(20, 120)}), kFrame), std::vector<int>{1});
}

TEST(PeopleTracker, OneAloneStaysOneOverACut) {
  PeopleTracker tracker;
  for (int t = 0; t < 10; ++t) tracker.push(sightings({walker(100)}), kFrame);
  EXPECT_EQ(tracker.push(sightings({walker(900)}), kFrame), std::vector<int>{0});
}

TEST(PeopleTracker, IdsInTheFileAreBelieved) {
  PeopleTracker tracker;
  EXPECT_EQ(tracker.push({{7, 1, walker(100)}, {3, 1, walker(400)}}, kFrame), (std::vector<int>{0, 1}));
  EXPECT_EQ(tracker.push({{3, 1, walker(100)}, {7, 1, walker(400)}}, kFrame), (std::vector<int>{1, 0}));
  EXPECT_EQ(tracker.number(0), 7);
  EXPECT_TRUE(tracker.believes_ids());
}

TEST(PeopleTracker, IdsThatAreTheSameForTwoAreNotBelieved) {
  PeopleTracker tracker;
  EXPECT_EQ(tracker.push({{0, 1, walker(100)}}, kFrame), std::vector<int>{0});
  EXPECT_EQ(tracker.push({{0, 1, walker(400)}, {0, 1, walker(101)}}, kFrame), (std::vector<int>{1, 0}));
  EXPECT_EQ(tracker.push({{0, 1, walker(401)}}, kFrame), std::vector<int>{1});
  EXPECT_FALSE(tracker.believes_ids());
}

TEST(PeopleTracker, SomebodyOfWhomOnlyAHandIsSeenIsOnePerson) {
  PeopleTracker tracker;
  for (int t = 0; t < 20; ++t) {
    FlatPose hand;
    hand.left_hand = small_part(walker(100 + 2.0f * static_cast<float>(t)), body25::LeftWrist, kHandPoints);
    EXPECT_EQ(tracker.push(sightings({walker(600), hand}), kFrame), (std::vector<int>{0, 1})) << t;
  }
}

TEST(PeopleTracker, CrowdsThatFlickerTakeBoundedTime) {
  PeopleTracker tracker;
  for (int t = 0; t < 30; ++t) {
    std::vector<FlatPose> crowd;
    for (int i = 0; i < 200; ++i)
      crowd.push_back(walker(static_cast<float>((i * 7919 + t * 104729) % 20000), 20));
    const std::vector<int> found = tracker.push(sightings(crowd), kFrame);
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), 200u);
  }
}

}  // namespace
}  // namespace understudy
