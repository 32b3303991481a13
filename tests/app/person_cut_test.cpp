#include "app/run/person_cut.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/run/retargeted_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "tests/retarget/scene/made_scene.hpp"

namespace understudy::app {
namespace {

using test::Actor;
using test::KnowingExtractor;
using test::MadeScene;

/// Frames of a made scene, and the truth of the last one that was read.
class MadeSource final : public Source {
 public:
  MadeSource(const MadeScene& scene, int64_t frames) : Source(30), scene_(scene), frames_(frames) {}
  std::optional<SourceFrame> next() override {
    if (at_ >= frames_) return std::nullopt;
    SourceFrame frame;
    frame.number = at_;
    frame.mesh = read(at_++);
    return frame;
  }
  void seek(int64_t frame) override {
    ++seeks;
    at_ = frame;
    if (frame > 0) read(frame - 1);  // who is looked at again is in that one
  }
  std::optional<int64_t> count() const override { return frames_; }

  std::vector<Joints> truth;
  int seeks = 0;

 private:
  Mesh read(int64_t at) {
    test::MadeScan made = scene_.frame(static_cast<int>(at));
    truth = made.joints;
    return std::move(made.scan);
  }

  const MadeScene& scene_;
  int64_t frames_, at_ = 0;
};

Actor actor_at(float x, int points) {
  Actor actor;
  actor.motion = "dance";
  actor.place = {x, 0, 0};
  actor.points = points;
  return actor;
}

/// A mannequin of many points, and somebody of fewer who dances.
MadeScene mannequin_and_dancer() {
  Actor mannequin = actor_at(0, 3000);
  mannequin.is_still = true;
  return MadeScene({mannequin, actor_at(1.4f, 2400)});
}

/// A source that is cut, frame by frame.
struct Cutting {
  Cutting(const MadeScene& scene, int64_t frames, const SourceOptions& options)
      : source(scene, frames), cut(std::make_shared<KnowingExtractor>(source.truth), options) {}
  std::optional<SourceFrame> next() {
    auto frame = source.next();
    if (frame) cut.apply(*frame, source, ++read);
    return frame;
  }
  MadeSource source;
  PersonCut cut;
  int64_t read = 0;
};

SourceOptions asking_for(const std::string& person) {
  SourceOptions options;
  options.path = "street";
  options.person = person;
  options.quiet = true;
  return options;
}

float middle_x(const Mesh& scan) {
  return scan.vertices.col(0).mean();
}

TEST(PersonCut, LeavesAPersonAloneUntouched) {
  const MadeScene scene({actor_at(0, 2000)});
  Cutting cutting(scene, 3, asking_for(""));
  for (int t = 0; t < 3; ++t) EXPECT_EQ(cutting.next()->mesh.vertices, scene.frame(t).scan.vertices) << t;
  EXPECT_EQ(cutting.cut.person(), 1);
  EXPECT_EQ(cutting.source.seeks, 0);
}

TEST(PersonCut, ChoosesWhoMovesInTheFirstSecondAndComesBack) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting cutting(scene, 40, asking_for(""));
  for (int t = 0; t < 40; ++t) {
    const auto frame = cutting.next();
    ASSERT_TRUE(frame && frame->usable) << t;
    EXPECT_EQ(frame->number, t);
    EXPECT_GT(middle_x(frame->mesh), 0.9f) << t;  // the dancer's, from the first frame on
  }
  EXPECT_FALSE(cutting.next());
  EXPECT_EQ(cutting.source.seeks, 1);
}

TEST(PersonCut, LooksNoFurtherThanTheEndOfAShortSource) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting cutting(scene, 2, asking_for(""));
  EXPECT_TRUE(cutting.next()->usable);
  EXPECT_TRUE(cutting.next()->usable);
  EXPECT_FALSE(cutting.next());
}

TEST(PersonCut, OfAFolderThatIsFollowedTheFirstFrameTells) {
  const MadeScene scene = mannequin_and_dancer();
  SourceOptions options = asking_for("");
  options.follow = true;
  Cutting cutting(scene, 5, options);
  for (int t = 0; t < 5; ++t) EXPECT_LT(middle_x(cutting.next()->mesh), 0.5f) << t;
  EXPECT_EQ(cutting.source.seeks, 0);
}

TEST(PersonCut, TheLargestIsWhoHasMostPoints) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting cutting(scene, 3, asking_for("largest"));
  EXPECT_LT(middle_x(cutting.next()->mesh), 0.5f);
}

TEST(PersonCut, ANumberIsThatPersonFromTheFirstFrameOn) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting one(scene, 2, asking_for("1")), other(scene, 2, asking_for("2"));
  const float x = middle_x(one.next()->mesh), y = middle_x(other.next()->mesh);
  EXPECT_GT(std::abs(x - y), 1.0f);
  EXPECT_EQ(one.source.seeks + other.source.seeks, 0);
  EXPECT_TRUE(one.cut.missing().empty());
}

TEST(PersonCut, AfterARestartTheSamePersonIsCutOut) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting cutting(scene, 40, asking_for(""));
  const float before = middle_x(cutting.next()->mesh);
  cutting.cut.restart();
  cutting.source.seek(0);
  cutting.read = 0;
  EXPECT_NEAR(middle_x(cutting.next()->mesh), before, 0.01f);
}

TEST(PersonCut, ANumberThatNobodyHasSaysWhoIsThere) {
  const MadeScene scene = mannequin_and_dancer();
  Cutting cutting(scene, 2, asking_for("7"));
  const auto frame = cutting.next();
  EXPECT_FALSE(frame->usable);
  EXPECT_EQ(frame->problem, "person 7 is not seen in it");
  EXPECT_EQ(cutting.cut.missing(),
            "there is no person 7 in it; it shows person 1 in 1 frame, person 2 in 1 frame");

  MadeSource source(scene, 2);
  Networks seeing;
  seeing.extractor = std::make_shared<KnowingExtractor>(source.truth);
  Retargeter retargeter(std::move(seeing));
  RetargetedSource retargeted(source, retargeter, asking_for("7"));
  while (retargeted.next()) {
  }
  try {
    retargeted.check_used();
    ADD_FAILURE() << "nobody has that number";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "street: there is no person 7 in it; it shows person 1 in 2 frames, person 2 in 2 frames");
  }
}

/// What is logged while it lives.
class Logged {
 public:
  Logged() : before_(log::set_sink([this](log::Level, const std::string& line) { all += line + "\n"; })) {}
  ~Logged() { log::set_sink(before_); }
  Logged(const Logged&) = delete;
  Logged& operator=(const Logged&) = delete;
  std::string all;

 private:
  log::Sink before_;
};

/// The first frame's messages.
std::string told_of(const MadeScene& scene, int64_t frames) {
  SourceOptions options = asking_for("");
  options.quiet = false;
  Logged logged;
  Cutting cutting(scene, frames, options);
  cutting.next();
  return logged.all;
}

TEST(PersonCut, OfMannequinsItSaysThatTheyDoNotMove) {
  EXPECT_EQ(
      told_of(mannequin_and_dancer(), 30),
      "street: 2 people are seen; person 2 is taken, who is seen best (--person chooses); person 1 does "
      "not move in the first second: somebody who stands still, or a mannequin\n");
  Actor one = actor_at(0, 2000), other = actor_at(1.4f, 2400);
  one.is_still = other.is_still = true;
  EXPECT_NE(told_of(MadeScene({one, other}), 30)
                .find("; people 1, 2 do not move in the first second: they stand still, or are mannequins"),
            std::string::npos);
}

TEST(PersonCut, OfACrowdOfThirtyItSaysHowManyAreFollowed) {
  std::vector<Actor> actors;
  for (int i = 0; i < 30; ++i) {
    actors.push_back(actor_at(1.3f * static_cast<float>(i % 6), 1500));
    actors.back().place.z() = 1.3f * static_cast<float>(i / 6);
    actors.back().first = 5 * i;
  }
  EXPECT_NE(
      told_of(MadeScene(actors), 1).find("street: a crowd: 12 people are followed, 18 more are left out\n"),
      std::string::npos);
}

/// Frames of a scene that the program goes through; what it says at the end, or of a frame.
std::string said_at_the_end(const MadeScene& scene, int64_t frames, const std::string& person = "") {
  MadeSource source(scene, frames);
  Networks seeing;
  seeing.extractor = std::make_shared<KnowingExtractor>(source.truth);
  Retargeter retargeter(std::move(seeing));
  RetargetedSource retargeted(source, retargeter, asking_for(person));
  while (retargeted.next()) {
  }
  try {
    retargeted.check_used();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(PersonCut, WhereNobodyIsItSaysSo) {
  MadeScene empty({});
  empty.add_ground(2, 6000);
  EXPECT_EQ(said_at_the_end(empty, 3), "street: no frame in it could be used: nobody is seen in it");
  empty.add_box({0.8f, 0.4f, 0.5f}, {0.3f, 0.4f, 0.3f}, 1500);
  EXPECT_EQ(said_at_the_end(empty, 3).find("street: no frame in it could be used: no person is recognised"),
            0u);
}

TEST(PersonCut, WhoEntersLateIsTakenFromThereOn) {
  Actor late = actor_at(0.3f, 2000);
  late.enters = 20;
  MadeScene scene({late});
  scene.add_ground(1.5f, 3000);
  Cutting cutting(scene, 26, asking_for(""));
  for (int t = 0; t < 26; ++t) {
    const auto frame = cutting.next();
    EXPECT_EQ(frame->usable, t >= 20) << t;
    if (t < 20) EXPECT_EQ(frame->problem, "nobody is seen in it");
    if (t >= 20) EXPECT_NEAR(static_cast<float>(frame->mesh.vertices.rows()), 2000, 100) << t;
  }
}

TEST(PersonCut, OfSomebodyAndADogThePersonIsTakenAndNobodyElseIsCounted) {
  MadeScene scene({actor_at(0, 2400)});
  scene.add_ground(2, 6000);
  scene.add_box({1, 0.5f, 0}, {0.35f, 0.13f, 0.1f}, 1200);
  for (const float x : {0.7f, 1.3f})
    for (const float z : {-0.07f, 0.07f}) scene.add_box({x, 0.22f, z}, {0.03f, 0.2f, 0.03f}, 200);
  EXPECT_EQ(told_of(scene, 2), "street: one person, and a ground, which are told apart in each frame\n");
}

TEST(PersonCut, AMirrorImageIsAnotherWhoCanBeChosen) {
  Actor person = actor_at(0.6f, 2400), image = person;
  image.mirror_x = 0, image.points = 1200;
  const MadeScene scene({person, image});
  EXPECT_GT(middle_x(Cutting(scene, 2, asking_for("largest")).next()->mesh), 0.3f);
  const float one = middle_x(Cutting(scene, 2, asking_for("1")).next()->mesh),
              two = middle_x(Cutting(scene, 2, asking_for("2")).next()->mesh);
  EXPECT_LT(one * two, 0) << "on either side of the mirror";
}

TEST(PersonCut, WhoCarriesAnotherIsTakenWithoutTheWordsOfTwo) {
  Actor carries = actor_at(0, 3000), carried = actor_at(0, 1500);
  carries.motion = carried.motion = "walk", carries.stature = 1.8f, carried.stature = 1.2f;
  carried.place = {0, 0.75f, -0.28f};
  MadeScene scene({carries, carried});
  scene.add_ground(2, 6000);
  Cutting cutting(scene, 10, asking_for(""));
  for (int t = 0; t < 10; ++t) ASSERT_TRUE(cutting.next()->usable) << t;
  EXPECT_EQ(cutting.cut.person(), 1);
}

}  // namespace
}  // namespace understudy::app
