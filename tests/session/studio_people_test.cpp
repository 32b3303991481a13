// Scans with a ground and several people, in the studio.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/session/take_export.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/scene/made_scene.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

using test::Actor;
using test::MadeScan;
using test::MadeScene;

constexpr int kShown = 8;

/// Two people 1.6 m apart on a ground, as one file, and all that is true of it.
class PeopleTest : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    Actor left, right;
    left.place = {-0.8f, 0, 0}, right.place = {0.8f, 0, 0.3f};
    left.points = 900, right.points = 1400;
    right.motion = "dance";
    write("scene.npz", {left, right}, /*ground=*/2500);
    write("alone.npz", {right}, 0);
  }

  void write(const std::string& name, const std::vector<Actor>& actors, int ground) {
    MadeScene scene(actors);
    if (ground > 0) scene.add_ground(1.8f, ground);
    NpyArray points;
    for (int t = 0; t < kShown; ++t) {
      MadeScan made = scene.frame(5 * t);
      points.shape = {kShown, made.scan.vertices.rows(), 3};
      points.values.insert(points.values.end(), made.scan.vertices.data(),
                           made.scan.vertices.data() + made.scan.vertices.size());
      if (ground == 0) continue;
      bones_.insert(bones_.end(), made.joints.begin(), made.joints.end());
      made_.push_back(std::move(made));
    }
    write_npz(path(name), {{"points", points}});
  }

  /// The scene in its own units, and what knows its bones.
  void open(Studio& studio, const std::string& name = "scene.npz") {
    studio.run("open", {path(name)});
    for (const char* line : {"source.units m", "source.up y", "source.floor 0"}) {
      const Arguments words = split_line(line);
      studio.run(words[0], {words[1]});
    }
    studio.run("open", {path("target.obj")});
    studio.wait_idle();
  }
  StudioServices knowing() {
    StudioServices own = services();
    own.networks = [usual = own.networks, this](const Method& method, const NetworkParts& parts) {
      Networks networks = usual(method, parts);
      if (networks.extractor) networks.extractor = std::make_shared<test::KnowingExtractor>(bones_);
      return networks;
    };
    return own;
  }

  /// Which of those who were made the source's skeleton is nearest to; 0: nobody within 5 cm.
  int follows(const Session& session, int frame) const {
    const auto& joints = made_[static_cast<size_t>(frame)].joints;
    for (size_t k = 0; k < joints.size(); ++k)
      if ((joints[k] - session.source.frames[frame].raw).rowwise().norm().mean() < 0.05f)
        return static_cast<int>(k) + 1;
    return 0;
  }
  /// The number of somebody who was made, by their points in a frame.
  int number_of(const Session& session, int made, int frame) const {
    const MadeScan& scan = made_[static_cast<size_t>(frame)];
    const auto& kept = session.source.frames[frame].owners;
    const std::vector<int> owner = kept ? kept->owners(scan.scan.vertices) : std::vector<int>();
    std::map<int, int> votes;
    for (size_t v = 0; v < owner.size(); ++v)
      if (scan.owner[v] == made) ++votes[owner[v]];
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == votes.end() ? 0 : most->first;
  }

  std::vector<MadeScan> made_;
  std::vector<Joints> bones_;
};

TEST_F(PeopleTest, OnePersonOfAScenePerformsWithoutAHandAndAnotherWhenChosen) {
  Studio studio(knowing());
  open(studio);
  const Session& session = studio.session();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  ASSERT_EQ(session.source.frames.size(), static_cast<size_t>(kShown));
  ASSERT_EQ(session.source.people.size(), 2u);
  for (const PersonSeen& one : session.source.people) {
    EXPECT_TRUE(one.is_sure) << one.id;
    EXPECT_EQ(one.frames, kShown) << one.id;
  }
  EXPECT_TRUE(has_several_people(session));
  EXPECT_TRUE(std::any_of(session.notices.begin(), session.notices.end(), [](const Notice& notice) {
    return notice.text.find("2 people are seen") == 0 && notice.offer.label.empty();
  }));
  const int first = follows(session, 0), other = 3 - first;
  ASSERT_GT(first, 0);
  const std::string before = std::to_string(session.source.person);
  for (int t = 0; t < kShown; ++t) {
    EXPECT_EQ(follows(session, t), first) << t;
    EXPECT_FALSE(session.source.frames[t].flagged) << session.source.frames[t].reason;
    EXPECT_EQ(number_of(session, first, t), session.source.person) << t;
    EXPECT_EQ(number_of(session, test::kGround, t), 0) << t;
  }
  EXPECT_EQ(session.takes[0].shown.poses.size(), static_cast<size_t>(kShown));

  studio.run("source.person", {std::to_string(number_of(session, other, 0))});
  EXPECT_EQ(session.history.undo_label(), "Choose person " + session.document.source.person);
  studio.wait_idle();
  for (int t = 0; t < kShown; ++t) EXPECT_EQ(follows(session, t), other) << t;
  EXPECT_EQ(session.source.people.size(), 2u);
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(follows(session, 3), first);
  EXPECT_EQ(std::to_string(session.source.person), before);
  studio.run("source.person", {"largest"});
  studio.wait_idle();
  EXPECT_EQ(follows(session, 3), 2) << "who has 1,400 points";
}

TEST_F(PeopleTest, TwoTargetsPerformTwoOfTheScans) {
  Studio studio(knowing());
  open(studio);
  const Session& session = studio.session();
  const int first = follows(session, 0), other = 3 - first;
  ASSERT_GT(first, 0);
  const std::string one = std::to_string(session.source.person),
                    two = std::to_string(number_of(session, other, 0));
  studio.run("target.add", {path("target.obj")});
  studio.run("take.person", {"1", two});
  EXPECT_EQ(session.history.undo_label(), "target: perform person " + two);
  studio.wait_idle();
  ASSERT_EQ(session.takes[1].shown.poses.size(), static_cast<size_t>(kShown));
  for (int t = 0; t < kShown; ++t) {
    EXPECT_EQ(follows(session, t), first) << t;
    const Joints& theirs = made_[static_cast<size_t>(t)].joints[static_cast<size_t>(other - 1)];
    EXPECT_LT((session.takes[1].another[t].raw - theirs).rowwise().norm().mean(), 0.05f) << t;
    EXPECT_EQ(session.takes[1].another[t].person, std::stoi(two)) << t;
  }
  // Each stands where their person stands.
  const auto place = [&](size_t k) { return Vec3(session.takes[k].shown.poses[0].root); };
  for (const size_t k : {0, 1}) {
    const Joints& theirs = made_[0].joints[static_cast<size_t>((k == 0 ? first : other) - 1)];
    EXPECT_NEAR(place(k).x(), theirs(Pelvis, 0), 0.06f) << k;
    EXPECT_NEAR(place(k).z(), theirs(Pelvis, 2), 0.06f) << k;
  }
  studio.run("export.run", {"0", path("both.glb"), "take=1"});
  studio.wait_idle();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  const Character both = read_character(path("both.glb"));
  ASSERT_EQ(both.animations.size(), 1u) << "they perform at once";
  const Points vertices = vertices_at(both, 0, 0);
  for (const int who : {first, other}) {  // one after the other, each where their person stands
    const Eigen::Index half = vertices.rows() / 2;
    const Vec3 middle = vertices.middleRows(who == first ? 0 : half, half).colwise().mean().transpose();
    const Vec3 theirs = made_[0].joints[static_cast<size_t>(who - 1)].row(Pelvis).transpose();
    EXPECT_NEAR(middle.x(), theirs.x(), 0.15f) << who;
    EXPECT_NEAR(middle.z(), theirs.z(), 0.15f) << who;
  }
  EXPECT_EQ(takes_of_one_file(session.document, 0), (std::vector<size_t>{0, 1}));
  Document named = session.document;
  named.source.person = two;  // by whom the other is the source's own, whether named or not
  named.takes[0].person.clear();
  named.takes[1].target.betas = {1};
  EXPECT_EQ(takes_of_one_file(named, 0), std::vector<size_t>{0}) << "two bodies of one person";
  EXPECT_FALSE(session.takes[1].metrics.empty()) << "measured against their own part of the scans";
  const Joints before = session.source.frames[2].joints;
  studio.run("take.person", {"0", two});
  studio.wait_idle();
  EXPECT_LT((session.source.frames[2].joints - before).rowwise().norm().maxCoeff(), 0.02f)
      << "the source stays who it was, though nobody performs it";
  studio.run("take.person", {"1", "source"});
  studio.wait_idle();
  EXPECT_NEAR(place(1).x(), made_[0].joints[static_cast<size_t>(first - 1)](Pelvis, 0), 0.06f);
  EXPECT_THROW(studio.run("take.person", {"1", "largest"}), Error);
  EXPECT_THROW(studio.run("take.person", {"1", "me"}), Error);
  studio.run("take.person", {"1", "7"});
  studio.wait_idle();
  EXPECT_EQ(session.takes[1].another[0].reason, "person 7 is not seen in it");
  studio.run("open", {path("alone.npz")});
  EXPECT_TRUE(session.document.takes[0].person.empty()) << "other scans, other people";
}

TEST_F(PeopleTest, WhoIsAloneIsNotCutAndWhoIsNotThereIsNamed) {
  Studio studio(knowing());
  open(studio, "alone.npz");
  const Session& session = studio.session();
  EXPECT_FALSE(session.source.has_scene);
  EXPECT_FALSE(has_several_people(session));
  ASSERT_EQ(session.source.people.size(), 1u);
  for (const KeptSource& frame : session.source.frames) {
    EXPECT_EQ(frame.owners, nullptr);
    EXPECT_EQ(frame.points, 1400);
  }
  studio.run("source.person", {"7"});
  studio.wait_idle();
  EXPECT_EQ(session.source.frames[0].reason, "person 7 is not seen in it");
  EXPECT_THROW(studio.run("source.person", {"all"}), Error);
  EXPECT_THROW(studio.run("source.person", {"me"}), Error);
}

TEST_F(PeopleTest, ExchangedIdentitiesFollowTheOtherFromThereOnAndBackWhenUndone) {
  Studio studio(knowing());
  open(studio);
  const Session& session = studio.session();
  const int first = follows(session, 0);
  ASSERT_GT(first, 0);
  const std::string one = std::to_string(number_of(session, first, 0)),
                    two = std::to_string(number_of(session, 3 - first, 0));
  studio.run("source.person", {one});
  studio.run("edit.people", {"4", "7", one, two, "exchange"});
  studio.wait_idle();
  for (int t = 0; t < kShown; ++t) EXPECT_EQ(follows(session, t), t < 4 ? first : 3 - first) << t;
  EXPECT_EQ(std::to_string(number_of(session, first, 5)), two);
  studio.run("edit.move", {"people", "0", "6", "7"});
  studio.wait_idle();
  EXPECT_EQ(follows(session, 5), first);
  EXPECT_EQ(follows(session, 6), 3 - first);
  studio.run("edit.undo");
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_TRUE(session.document.source.people.empty());
  for (int t = 0; t < kShown; ++t) EXPECT_EQ(follows(session, t), first) << t;
}

TEST_F(PeopleTest, SomebodyIsSplitOffOverARangeAndTwoAreJoined) {
  Studio studio(knowing());
  open(studio);
  const Session& session = studio.session();
  const int first = follows(session, 0);
  const std::string one = std::to_string(session.source.person),
                    two = std::to_string(number_of(session, 3 - first, 0));
  studio.run("source.person", {one});
  studio.run("edit.people", {"2", "3", one, "9", "exchange"});
  studio.wait_idle();
  EXPECT_EQ(session.source.frames[2].reason, "person " + one + " is not seen in it");
  EXPECT_EQ(follows(session, 4), first);
  ASSERT_EQ(session.source.people.size(), 3u);
  EXPECT_EQ(session.source.people[2].id, 9);
  EXPECT_EQ(session.source.people[2].frames, 2);
  studio.run("edit.remove", {"people", "0"});
  studio.run("edit.people", {"0", "7", one, two, "join"});
  studio.wait_idle();
  ASSERT_EQ(session.source.people.size(), 1u);
  for (int t = 0; t < kShown; ++t) EXPECT_GT(session.source.frames[t].points, 2200) << t;
  for (const char* wrong : {"0 7 1 1 join", "0 7 1 88 join", "3 2 1 2 exchange", "0 8 1 2 exchange",
                            "0 7 5 1 exchange", "0 7 1 2 blend"})
    EXPECT_THROW(studio.run("edit.people", split_line(wrong)), Error) << wrong;
}

TEST(KeptOwnersTest, GivesBackWhoseEachFinitePointIs) {
  Points points = Points::Random(500, 3);
  SceneFrame scene;
  for (int v = 0; v < 500; ++v) scene.owner.push_back(v % 4 - 1);
  const std::vector<int> whole = scene.owner;
  points.row(7).setConstant(std::nanf(""));
  const auto kept = KeptOwners::of(points, scene, 1);
  ASSERT_NE(kept, nullptr);
  std::vector<int> wanted = whole;
  wanted[7] = People::kNobody;
  EXPECT_EQ(kept->owners(points), wanted);
  Points finite(499, 3);
  finite << points.topRows(7), points.bottomRows(492);
  wanted.erase(wanted.begin() + 7);
  EXPECT_EQ(kept->owners(finite), wanted) << "the scan is drawn without them";
  EXPECT_TRUE(kept->owners(Points::Zero(20, 3)).empty()) << "another scan";
  ASSERT_EQ(kept->people().size(), 2u);
  EXPECT_TRUE(kept->people().at(1).contains(points.row(6)));
  SceneFrame alone;
  alone.alone = 3;
  EXPECT_EQ(KeptOwners::of(points, alone, 3), nullptr);
  EXPECT_EQ(KeptOwners::of(points, alone, 1)->owners(finite), std::vector<int>(499, 3));
}

}  // namespace
}  // namespace understudy::app
