#include "retarget/scene/scene.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "retarget/base/clock.hpp"
#include "tests/retarget/scene/made_scene.hpp"

namespace understudy {
namespace {

using test::Actor;
using test::KnowingExtractor;
using test::MadeScan;
using test::MadeScene;

/// How a scene was taken apart, over frames.
struct Judged {
  double right = 0, all = 0;         // points, and of them those whose owner is right
  std::map<int, std::set<int>> ids;  // of each true person
  std::map<int, int> last_id;        // of each true person, in the last frame that shows them
  std::vector<ScenePerson> people;   // of the last frame
  int left_out = 0, looks = 0;
  double share() const { return right / all; }
};

void judge(const MadeScan& made, const SceneFrame& frame, Judged& judged) {
  std::vector<int> owner = frame.owner;
  if (owner.empty()) owner.assign(made.owner.size(), frame.alone);
  std::map<int, std::map<int, int>> counts;
  for (size_t i = 0; i < owner.size(); ++i) ++counts[made.owner[i]][owner[i]];
  judged.all += static_cast<double>(owner.size());
  for (const auto& [truth, found] : counts) {
    int id = 0, most = 0;
    for (const auto& [one, n] : found) {
      if (truth == test::kGround && one <= 0) judged.right += n;
      if (one > 0 && n > most) most = n, id = one;
    }
    if (truth == test::kGround || id == 0) continue;
    judged.right += most;
    judged.ids[truth].insert(id);
    judged.last_id[truth] = id;
  }
}

Judged watch(const MadeScene& scene, int first, int last) {
  std::vector<Joints> truth;
  const auto extractor = std::make_shared<KnowingExtractor>(truth);
  Scene stage(extractor);
  Judged judged;
  for (int t = first; t < last; ++t) {
    const MadeScan made = scene.frame(t);
    truth = made.joints;
    const SceneFrame frame = stage.push(made.scan, 1.0f / 30);
    judge(made, frame, judged);
    judged.people = frame.people;
    judged.left_out = frame.left_out;
  }
  judged.looks = extractor->looks;
  return judged;
}

Actor somebody(const Vec3& place, const std::string& motion = "dance", float stature = 1.7f) {
  Actor actor;
  actor.motion = motion;
  actor.place = place;
  actor.stature = stature;
  return actor;
}

SceneFrame first_frame(const MadeScan& made) {
  std::vector<Joints> truth = made.joints;
  return Scene(std::make_shared<KnowingExtractor>(truth)).push(made.scan, 1.0f / 30);
}

TEST(Scene, PersonAlonePassesThroughUntouchedAndIsNotLookedAtInEachFrame) {
  const MadeScene made({somebody({0, 0, 0})});
  std::vector<Joints> truth;
  const auto extractor = std::make_shared<KnowingExtractor>(truth);
  Scene stage(extractor);
  for (int t = 0; t < 60; t += 2) {
    const MadeScan scan = made.frame(t);
    truth = scan.joints;
    const SceneFrame frame = stage.push(scan.scan, 1.0f / 30);
    ASSERT_TRUE(frame.owner.empty());
    ASSERT_EQ(frame.alone, 1);
    EXPECT_EQ(part_of(scan.scan, frame, 1).vertices, scan.scan.vertices);
    EXPECT_FALSE(frame.ground);
  }
  EXPECT_LE(extractor->looks, 1);
}

TEST(Scene, WideSkirtStaysOnItsPerson) {
  MadeScene made({somebody({0, 0, 0}, "walk")});
  Rng rng(4);
  Points cone(4000, 3);  // from the hips to the shins, 0.4 m about the axis there
  for (auto row : cone.rowwise()) {
    const float down = std::sqrt(rng.uniform()), angle = rng.uniform(0, 2 * kPi);
    const float radius = 0.15f + down * 0.25f;
    row << radius * std::cos(angle), 0.95f - 0.7f * down, radius * std::sin(angle);
  }
  const Vec3 pelvis = made.frame(3).joints[0].row(0).transpose();
  cone.rowwise() += Vec3(pelvis.x(), 0, pelvis.z()).transpose();
  made.add_points(cone);
  const MadeScan scan = made.frame(3);
  /// As sure of somebody in skirts as the extractor is.
  struct Sure final : SkeletonExtractor {
    explicit Sure(Joints seen) : joints(std::move(seen)) {}
    Extraction extract(const Mesh&) override {
      Extraction seen;
      seen.joints = joints;
      seen.confidence.setConstant(0.9f);
      return seen;
    }
    std::string name() const override { return "sure"; }
    Joints joints;
  };
  const SceneFrame frame = Scene(std::make_shared<Sure>(scan.joints[0])).push(scan.scan, 1.0f / 30);
  EXPECT_TRUE(frame.owner.empty());
  EXPECT_EQ(frame.alone, 1);
}

TEST(Scene, WithoutAnExtractorAllIsOnePerson) {
  MadeScene made({somebody({0, 0, 0}), somebody({1.1f, 0, 0})});
  made.add_ground(1.5f, 6000);
  EXPECT_EQ(Scene(nullptr).push(made.frame(0).scan, 1.0f / 30).alone, 1);
}

TEST(Scene, GroundIsTakenAwayAndSolesStay) {
  MadeScene made({somebody({0, 0, 0}, "walk")});
  made.add_ground(1.5f, 9000);
  const Judged judged = watch(made, 0, 20);
  EXPECT_GT(judged.share(), 0.985);
  EXPECT_EQ(judged.people.size(), 1u);
  const MadeScan scan = made.frame(3);
  const Mesh left = part_of(scan.scan, first_frame(scan), 1);
  EXPECT_LT(left.vertices.col(1).minCoeff(), 0.015f);
}

TEST(Scene, TiltedNoisyGroundIsTakenAwayToo) {
  MadeScene made({somebody({0.3f, 0.02f, 0.2f}, "walk")});
  made.add_ground(1.5f, 9000, 0.02f, 4);
  EXPECT_GT(watch(made, 0, 20).share(), 0.96);
}

TEST(Scene, TwoPeopleBesideEachOtherAreTwo) {
  for (const bool with_ground : {false, true}) {
    MadeScene made({somebody({0, 0, 0}), somebody({1.1f, 0, 0}, "walk", 1.6f)});
    if (with_ground) made.add_ground(2, 9000);
    const Judged judged = watch(made, 0, 30);
    EXPECT_GT(judged.share(), 0.985) << with_ground;
    EXPECT_EQ(judged.people.size(), 2u);
    EXPECT_EQ(judged.ids.at(1).size(), 1u);
    EXPECT_EQ(judged.ids.at(2).size(), 1u);
  }
}

TEST(Scene, PersonBesideATableAndACabinetIsOne) {
  MadeScene made({somebody({0, 0, 0})});
  made.add_box({0.95f, 0.72f, 0}, {0.5f, 0.02f, 0.35f}, 1500);
  for (const float x : {0.5f, 1.4f})
    for (const float z : {-0.3f, 0.3f}) made.add_box({x, 0.35f, z}, {0.02f, 0.35f, 0.02f}, 150);
  made.add_box({-0.95f, 0.9f, -0.3f}, {0.3f, 0.9f, 0.25f}, 4000);
  const Judged judged = watch(made, 0, 30);
  EXPECT_GT(judged.share(), 0.97);
  ASSERT_EQ(judged.people.size(), 1u);
  EXPECT_TRUE(judged.people[0].is_sure);
}

TEST(Scene, PeopleWhoCrossKeepTheirIdentities) {
  Actor first = somebody({-0.35f, 0, -1.5f}, "walk"), second = somebody({0.35f, 0, 2.5f}, "walk", 1.8f);
  second.turn_deg = 180;
  MadeScene made({first, second});
  made.add_ground(3, 12000);
  const Judged judged = watch(made, 0, 90);
  EXPECT_GT(judged.share(), 0.98);
  EXPECT_EQ(judged.ids.at(1).size(), 1u);
  EXPECT_EQ(judged.ids.at(2).size(), 1u);
}

TEST(Scene, PeopleWhoTouchAreSharedOutBetweenThem) {
  Actor first = somebody({-0.4f, 0, 0}), second = somebody({0.4f, 0, 0});
  second.first = 40;
  MadeScene made({first, second});
  made.add_ground(2, 9000);
  const Judged judged = watch(made, 0, 60);
  EXPECT_GT(judged.share(), 0.95);
  EXPECT_EQ(judged.ids.at(1).size(), 1u);
  EXPECT_EQ(judged.ids.at(2).size(), 1u);
}

TEST(Scene, WhoLeavesAndReturnsKeepsTheNumber) {
  Actor stays = somebody({0, 0, 0}), leaves = somebody({1.2f, 0, 0}, "dance", 1.5f), returns = leaves;
  leaves.leaves = 20;
  returns.enters = 70;
  MadeScene made({stays, leaves, returns});
  made.add_ground(2, 9000);
  const Judged judged = watch(made, 0, 90);
  EXPECT_EQ(judged.last_id.at(2), judged.last_id.at(3));
  EXPECT_NE(judged.last_id.at(1), judged.last_id.at(2));
}

TEST(Scene, WhoEntersLateIsFound) {
  Actor late = somebody({1.2f, 0, 0}, "walk");
  late.enters = 40;
  MadeScene made({somebody({0, 0, 0}), late});
  const Judged judged = watch(made, 30, 60);
  EXPECT_GT(judged.share(), 0.97);
  EXPECT_EQ(judged.people.size(), 2u);
  EXPECT_EQ(judged.last_id.at(1), 1);
}

TEST(Scene, OfAPersonAndADogThePersonAloneIsOne) {
  MadeScene made({somebody({0, 0, 0})});
  made.add_ground(2, 9000);
  made.add_box({1, 0.5f, 0}, {0.35f, 0.13f, 0.1f}, 1200);
  for (const float x : {0.7f, 1.3f})
    for (const float z : {-0.07f, 0.07f}) made.add_box({x, 0.22f, z}, {0.03f, 0.2f, 0.03f}, 200);
  made.add_box({0.62f, 0.75f, 0}, {0.12f, 0.09f, 0.08f}, 300);
  const Judged judged = watch(made, 0, 20);
  ASSERT_EQ(judged.people.size(), 1u);
  EXPECT_GT(judged.share(), 0.97);
}

TEST(Scene, AMirrorImageIsAnotherAndTakesNothingOfThePersonBeforeTheMirror) {
  Actor person = somebody({0.6f, 0, 0}), image = person;
  image.mirror_x = 0;
  MadeScene made({person, image});
  made.add_ground(2, 9000);
  const Judged judged = watch(made, 0, 60);
  EXPECT_EQ(judged.people.size(), 2u);
  EXPECT_GT(judged.share(), 0.98);
  EXPECT_EQ(judged.ids.at(1).size(), 1u);
  EXPECT_EQ(judged.ids.at(2).size(), 1u);
  EXPECT_NE(judged.last_id.at(1), judged.last_id.at(2));
}

TEST(Scene, WhoCarriesAnotherIsFollowedWithOneNumber) {
  Actor carries = somebody({0, 0, 0}, "walk", 1.8f), carried = somebody({0, 0.75f, -0.28f}, "walk", 1.2f);
  MadeScene made({carries, carried});
  made.add_ground(2, 9000);
  const Judged judged = watch(made, 0, 30);
  ASSERT_FALSE(judged.people.empty());
  EXPECT_TRUE(judged.people[0].is_sure);
  EXPECT_EQ(judged.ids.at(1), std::set<int>{1});
  EXPECT_GT(judged.share(), 0.75);  // where one body ends on the other is a guess
}

TEST(Scene, WhoEntersInFrame200IsFoundThere) {
  Actor first = somebody({0, 0, 0}, "walk"), second = somebody({1.2f, 0, 0}, "dance", 1.6f);
  first.enters = second.enters = 200;
  first.points = second.points = 1500;
  MadeScene made({first, second});
  made.add_ground(1.5f, 2500);
  std::vector<Joints> truth;
  const auto extractor = std::make_shared<KnowingExtractor>(truth);
  Scene stage(extractor);
  Judged judged;
  for (int t = 0; t < 206; ++t) {
    const MadeScan scan = made.frame(t);
    truth = scan.joints;
    const SceneFrame frame = stage.push(scan.scan, 1.0f / 30);
    ASSERT_EQ(frame.people.size(), t < 200 ? 0u : 2u) << t;
    judge(scan, frame, judged);
  }
  EXPECT_EQ(judged.last_id.at(1) + judged.last_id.at(2), 1 + 2);
  EXPECT_GT(judged.share(), 0.97);
  EXPECT_LT(extractor->looks, 20);
}

TEST(Scene, MannequinsNeverMove) {
  Actor still = somebody({0, 0, 0}), other = somebody({1.2f, 0, 0}, "walk");
  still.is_still = other.is_still = true;
  MadeScene made({still, other, somebody({-1.4f, 0, 0})});
  made.add_ground(2.5f, 9000);
  const Judged judged = watch(made, 0, 30);
  ASSERT_EQ(judged.people.size(), 3u);
  for (const ScenePerson& person : judged.people) {
    const bool moves = person.id == judged.last_id.at(3);
    EXPECT_EQ(person.moved_m > 0.03f, moves) << person.id << " " << person.moved_m;
  }
}

TEST(Scene, OfACrowdAsManyAreFollowedAsItSays) {
  std::vector<Actor> actors;
  for (int i = 0; i < 30; ++i) {
    actors.push_back(somebody({1.3f * static_cast<float>(i % 6), 0, 1.3f * static_cast<float>(i / 6)}));
    actors.back().points = 1500;
    actors.back().first = 5 * i;
  }
  const Judged judged = watch(MadeScene(actors), 0, 2);
  EXPECT_EQ(judged.people.size(), static_cast<size_t>(People::kMost));
  EXPECT_EQ(judged.left_out, 30 - People::kMost);
}

TEST(Scene, NobodyIsFoundWhereNobodyIs) {
  MadeScene made({});
  made.add_ground(2, 9000);
  const SceneFrame frame = first_frame(made.frame(0));
  EXPECT_TRUE(frame.people.empty());
  ASSERT_FALSE(frame.owner.empty());
  for (const int owner : frame.owner) ASSERT_LE(owner, 0);
}

TEST(Scene, AllPointsInOnePlaneAreNobody) {
  for (const bool upright : {false, true}) {
    Rng rng(3);
    Mesh plane;
    plane.vertices.resize(8000, 3);
    for (auto row : plane.vertices.rowwise()) {
      const float a = rng.uniform(-1.6f, 1.6f), b = rng.uniform(-1.6f, 1.6f);
      row << a, upright ? b : 0, upright ? 0 : b;
    }
    std::vector<Joints> nobody;
    const SceneFrame frame = Scene(std::make_shared<KnowingExtractor>(nobody)).push(plane, 1.0f / 30);
    for (const ScenePerson& person : frame.people) EXPECT_FALSE(person.is_sure) << upright;
  }
}

TEST(Scene, StairsAreNobody) {
  MadeScene made({somebody({0, 0, -0.6f})});
  made.add_ground(1.2f, 6000);
  for (int step = 1; step < 5; ++step) {
    const auto k = static_cast<float>(step);
    made.add_box({0, 0.09f * k, 0.3f + 0.3f * k}, {0.7f, 0.09f * k, 0.15f}, 1500);
  }
  const Judged judged = watch(made, 0, 10);
  ASSERT_EQ(judged.people.size(), 1u);
  EXPECT_GT(judged.share(), 0.95);
}

TEST(Scene, FiveMillionPointsAreTakenApart) {
  Actor dense = somebody({0, 0, 0});
  dense.points = 1000000;
  MadeScene made({dense});
  made.add_ground(3, 4000000);
  const MadeScan scan = made.frame(0);
  const SceneFrame frame = first_frame(scan);
  ASSERT_EQ(frame.people.size(), 1u);
  EXPECT_GT(frame.people[0].points, 900000);
}

TEST(Scene, PointsThatAreNotFiniteAreNobodys) {
  MadeScene made({somebody({0, 0, 0}), somebody({1.2f, 0, 0})});
  MadeScan scan = made.frame(0);
  scan.scan.vertices(10, 1) = NAN;
  scan.scan.vertices(20, 0) = 1e30f;
  const SceneFrame frame = first_frame(scan);
  ASSERT_FALSE(frame.owner.empty());
  EXPECT_EQ(frame.owner[10], People::kNobody);
  EXPECT_EQ(frame.owner[20], People::kNobody);
}

TEST(Scene, SameScansGiveTheSameOwners) {
  MadeScene made({somebody({-0.4f, 0, 0}), somebody({0.4f, 0, 0}, "walk")});
  made.add_ground(2, 6000);
  const MadeScan scan = made.frame(5);
  EXPECT_EQ(first_frame(scan).owner, first_frame(scan).owner);
}

}  // namespace
}  // namespace understudy
