// The map of motions: read in the background, asked for what is alike, taken from as a source.
#include <algorithm>
#include <cmath>

#include "app/run/step_index.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/session/studio_fixture.hpp"
#include "tests/support/plain_coder.hpp"

namespace understudy::app {
namespace {

class StudioMap : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    fs::create_directories(path("motions"));
    tests::WalkOptions fast;
    fast.fps = 48;
    tests::write_walk(path("motions/walk.npz"));
    tests::write_walk(path("motions/run.npz"), fast);
    tests::WalkOptions still;
    still.motion = "still";
    tests::write_walk(path("motions/still.npz"), still);
  }
  StudioServices with_coder() {
    StudioServices own = services();
    own.motion_coder = [] { return std::make_shared<tests::PlainCoder>(); };
    return own;
  }
  void read_all(Studio& studio) {
    studio.run("map.index", {path("motions")});
    studio.wait_idle();
    ASSERT_TRUE(studio.session().map.any());
  }
  /// The number of a step of this file.
  static int step_of(const Studio& studio, const std::string& name) {
    const MotionMap& map = *studio.session().map.map;
    for (int i = 0; i < map.size(); ++i)
      if (map.motion_of(i).name == name) return i;
    return -1;
  }
  static std::string refused(Studio& studio, const std::string& command, const Arguments& arguments) {
    return failure_of([&] { studio.run(command, arguments); });
  }
};

TEST_F(StudioMap, HoldsTheStepsOfAFolderAndTellsHowMany) {
  Studio studio(with_coder());
  read_all(studio);
  const MapState& map = studio.session().map;
  EXPECT_EQ(map.map->motions().size(), 2u);
  EXPECT_EQ(map.words.find("3 files, 3 read anew, "), 0u) << map.words;
  ASSERT_TRUE(map.colouring);
  EXPECT_EQ(map.colouring->groups.size(), 2u) << "by action, here the files' names";
  ASSERT_FALSE(studio.session().notices.empty());
  EXPECT_EQ(studio.session().notices.back().text, "On the map: " + map.words);
  EXPECT_FALSE(studio.session().changed) << "no edit of the document";
}

TEST_F(StudioMap, IsColouredByWhatIsAsked) {
  Studio studio(with_coder());
  studio.run("map.color", {"duration"});
  read_all(studio);
  EXPECT_EQ(studio.session().map.colouring->unit, "s") << "as was asked before";
  studio.run("map.color", {"speed"});
  EXPECT_EQ(studio.session().map.colouring->unit, "m/s");
  EXPECT_NE(refused(studio, "map.color", {"age"}), "");
}

TEST_F(StudioMap, AStepIsTakenAsTheSourceWithItsFramesMarkedAndUndone) {
  Studio studio(with_coder());
  open_both(studio);
  read_all(studio);
  const int run = step_of(studio, "run.npz");
  studio.run("map.take", {std::to_string(run)});
  studio.wait_idle();
  const Session& session = studio.session();
  EXPECT_EQ(session.document.source.path, path("motions/run.npz"));
  EXPECT_EQ(session.playback.in, session.map.map->step(run).first);
  EXPECT_EQ(session.playback.out, session.map.map->step(run).last);
  EXPECT_TRUE(session.playback.playing);
  EXPECT_GE(shown_frame(session), session.playback.in);
  EXPECT_LE(shown_frame(session), session.playback.out);
  EXPECT_EQ(session.takes.at(0).shown.poses.size(), session.source.frames.size()) << "the target performs it";
  EXPECT_TRUE(session.errors.empty());
  EXPECT_EQ(undo_label(session).find("Take run.npz, frames "), 0u) << undo_label(session);
  studio.run("edit.undo");
  EXPECT_EQ(session.document.source.path, path("scan.npz"));
}

TEST_F(StudioMap, AnotherStepOfTheSourceIsNoEdit) {
  Studio studio(with_coder());
  studio.run("source.open", {path("motions/walk.npz")});
  read_all(studio);
  studio.wait_idle();
  const std::string label = undo_label(studio.session());
  studio.run("map.take", {std::to_string(step_of(studio, "walk.npz") + 2)});
  EXPECT_EQ(undo_label(studio.session()), label);
  EXPECT_EQ(studio.session().playback.in,
            studio.session().map.map->step(step_of(studio, "walk.npz") + 2).first);
}

TEST_F(StudioMap, ThePlaceOfAStepIsTakenAsItAndOneBetweenAsABlend) {
  Studio studio(with_coder());
  read_all(studio);
  const MotionMap& map = *studio.session().map.map;
  const auto decode = [&](const MapPlace& at) {
    studio.run("map.decode", {std::to_string(at.x()), std::to_string(at.y())});
    studio.wait_idle();
  };
  const int walk = step_of(studio, "walk.npz"), run = step_of(studio, "run.npz");
  decode(map.place(walk));
  const SourceOptions& source = studio.session().document.source;
  EXPECT_EQ(source.path, path("motions/walk.npz"));
  EXPECT_FALSE(source.blend);
  decode(0.5f * (map.place(walk) + map.place(run)));
  ASSERT_TRUE(source.blend);
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_GE(source.blend->parts.size(), 2u);
  float sum = 0;
  for (const BlendPart& part : source.blend->parts) {
    EXPECT_TRUE(part.range) << "the step, not the whole file";
    sum += part.weight;
  }
  EXPECT_NEAR(sum, 1, 1e-4f);
  ASSERT_TRUE(studio.session().map.decoded);
  EXPECT_NE(studio.session().notices.back().text.find("times as far from the nearest step as neighbours are"),
            std::string::npos);
  EXPECT_GT(studio.session().source.frames.size(), 5u) << "it is performed";
}

TEST_F(StudioMap, LikeARangeAreThoseOfItsKind) {
  Studio studio(with_coder());
  studio.run("source.open", {path("motions/walk.npz")});
  read_all(studio);
  const MotionMap& map = *studio.session().map.map;
  const MappedStep& asked = map.step(step_of(studio, "walk.npz"));
  studio.run("map.like", {std::to_string(asked.first), std::to_string(asked.last)});
  studio.wait_idle();
  const MapState& state = studio.session().map;
  ASSERT_GE(state.like.size(), 2u);
  EXPECT_EQ(map.motion_of(state.like[0].step).name, "walk.npz") << "another cycle of the walk";
  for (const NearStep& near : state.like)
    EXPECT_FALSE(map.motion_of(near.step).name == "walk.npz" && map.step(near.step).first <= asked.last &&
                 map.step(near.step).last >= asked.first)
        << "not itself";
  EXPECT_EQ(state.like_what.find("frames "), 0u);
}

TEST_F(StudioMap, ARangeWhereNobodyStepsIsToldInOneSentence) {
  Studio studio(with_coder());
  studio.run("source.open", {path("motions/walk.npz")});
  read_all(studio);
  studio.run("map.like", {"3", "9"});
  studio.wait_idle();
  ASSERT_FALSE(studio.session().errors.empty());
  EXPECT_NE(
      studio.session().errors.front().text.find("nobody makes a whole step (0.3 to 3 s) in frames 3 to 9"),
      std::string::npos)
      << studio.session().errors.front().text;
  EXPECT_TRUE(studio.session().map.like.empty());
}

TEST_F(StudioMap, WithoutAFolderHoldsTheOpenMotionAlone) {
  Studio studio(with_coder());
  EXPECT_NE(refused(studio, "map.index", {}).find("nothing is open"), std::string::npos);
  studio.run("source.open", {path("motions/walk.npz")});
  studio.run("map.index");
  studio.wait_idle();
  ASSERT_TRUE(studio.session().map.any());
  EXPECT_EQ(studio.session().map.map->motions().size(), 1u);
}

TEST_F(StudioMap, OfMotionsInWhichNobodyStepsShowsWhatElseIsInThem) {
  Studio studio(with_coder());
  studio.run("map.index", {path("motions/still.npz")});
  studio.wait_idle();
  const MapState& map = studio.session().map;
  EXPECT_EQ(map.shown, MapOf::Others);
  ASSERT_TRUE(map.any());
  EXPECT_EQ(map.map->motion_of(0).name, "still.npz");
  EXPECT_NE(map.words.find("0 steps in 0 motions, "), std::string::npos) << map.words;
  studio.run("map.take", {"0"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.source.path, path("motions/still.npz"));
  studio.run("map.show", {"steps"});
  EXPECT_FALSE(map.any());
  EXPECT_NE(refused(studio, "map.take", {"0"}), "");
  EXPECT_NE(refused(studio, "map.decode", {"0", "0"}), "");
  EXPECT_NE(refused(studio, "map.like", {"0", "30"}), "");
}

TEST_F(StudioMap, OfMotionsThatAreTooBriefIsEmptyAndSaysSo) {
  tests::WalkOptions brief;
  brief.motion = "still";
  brief.fps = 1000;
  tests::write_walk(path("brief.npz"), brief);
  Studio studio(with_coder());
  studio.run("map.index", {path("brief.npz")});
  studio.wait_idle();
  EXPECT_FALSE(studio.session().map.any());
  ASSERT_FALSE(studio.session().notices.empty());
  EXPECT_EQ(studio.session().notices.back().text.find("Nobody moves in any of these motions for a second: 1"),
            0u);
}

TEST_F(StudioMap, MovementsThatAreNoStepsAreShownAndComparedByThemselves) {
  Studio studio(with_coder());
  studio.run("source.open", {path("motions/still.npz")});
  read_all(studio);
  const MapState& map = studio.session().map;
  EXPECT_EQ(map.shown, MapOf::Steps);
  studio.run("map.show", {"others"});
  ASSERT_TRUE(map.any());
  for (int i = 0; i < map.map->size(); ++i) EXPECT_NE(map.map->motion_of(i).name, "walk.npz");
  studio.run("map.like", {"0", "40"});
  studio.wait_idle();
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_FALSE(map.like.empty());
  EXPECT_NE(refused(studio, "map.show", {"people"}), "");
}

TEST_F(StudioMap, ATargetPerformsAStepThatIsPointedAtAndIsAsItWasAfterwards) {
  Studio studio(with_coder());
  open_walk(studio);
  read_all(studio);
  const Session& session = studio.session();
  const int step = step_of(studio, "walk.npz");
  const Pose before = session.takes.at(0).shown.poses.at(static_cast<size_t>(shown_frame(session)));
  studio.run("map.perform", {std::to_string(step)});
  ASSERT_TRUE(session.map.performance);
  const StepPerformance& performance = *session.map.performance;
  const auto& frames = performance.takes.at(0);
  ASSERT_GT(frames.size(), 20u);
  EXPECT_NEAR(static_cast<float>(frames.size() - 1) / performance.fps, session.map.map->step(step).seconds,
              1e-3f);
  const Vec3 middle = 0.5f * (frames.front().pose.root + frames.back().pose.root);
  EXPECT_LT(std::hypot(middle.x() - before.root.x(), middle.z() - before.root.z()), 1e-3f)
      << "where it stands";
  EXPECT_GT((frames.back().pose.root - frames.front().pose.root).norm(), 0.5f) << "it walks";
  EXPECT_EQ(performance.frame_at(performance.since, 0), 0);
  EXPECT_EQ(performance.frame_at(performance.since + 10.5 / static_cast<double>(performance.fps), 0), 10);
  const double lap = static_cast<double>(ssize(frames)) / static_cast<double>(performance.fps);
  EXPECT_EQ(performance.frame_at(performance.since + lap + 1e-4, 0), 0) << "over and over";
  FrameCache& cache = studio.cache();
  EXPECT_FALSE(cache.performing(session.takes[0], 0, frames, 10)) << "it is being made";
  cache.wait();
  const auto picture = cache.performing(session.takes[0], 0, frames, 10);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->vertices, session.takes[0].deformer->deform(frames[10].pose));
  cache.performing(session.takes[0], 0, frames, 12);
  EXPECT_TRUE(cache.performing(session.takes[0], 0, frames, 14)) << "the last that is made";
  studio.run("map.perform");
  EXPECT_FALSE(session.map.performance);
  EXPECT_EQ(session.takes[0].shown.poses.at(static_cast<size_t>(shown_frame(session))).root, before.root);
}

TEST_F(StudioMap, WhatIsPointedAtIsPerformedAsItIsWhenItIsTaken) {
  Studio studio(with_coder());
  open_walk(studio);
  read_all(studio);
  const Session& session = studio.session();
  const int step = step_of(studio, "run.npz");
  studio.run("map.perform", {std::to_string(step)});
  const auto pointed = session.map.performance->takes.at(0);
  studio.run("map.take", {std::to_string(step)});
  studio.wait_idle();
  const int first = session.map.map->step(step).first, last = session.map.map->step(step).last;
  float worst = 0;
  for (const size_t i : {size_t{5}, pointed.size() / 2, pointed.size() - 1}) {
    const float share = static_cast<float>(i) / static_cast<float>(pointed.size() - 1);
    const int frame = first + static_cast<int>(std::lround(share * static_cast<float>(last - first)));
    const Pose& taken = session.takes.at(0).shown.poses.at(static_cast<size_t>(frame));
    for (int j = LeftHip; j < LeftShoulder; ++j)
      worst = std::max(worst, geodesic_angle(taken.local[j], pointed[i].pose.local[j]));
  }
  EXPECT_LT(worst, 0.2f) << "radians, of any joint but the arms', whose contacts are kept in takes alone";
}

TEST_F(StudioMap, RefusesStepsAndFoldersThatAreNotThere) {
  Studio studio(with_coder());
  EXPECT_NE(refused(studio, "map.index", {path("nowhere")}).find("there is no such file or folder"),
            std::string::npos);
  read_all(studio);
  EXPECT_NE(refused(studio, "map.take", {"1000"}).find("there is no step 1000"), std::string::npos);
  EXPECT_NE(refused(studio, "map.take", {"-1"}), "");
  fs::remove(path("motions/run.npz"));
  EXPECT_NE(refused(studio, "map.take", {std::to_string(step_of(studio, "run.npz"))})
                .find("there is no such file any more"),
            std::string::npos);
}

TEST_F(StudioMap, IsReadAgainFromTheIndexAlone) {
  StudioServices own = with_coder();
  own.autosave_folder = path("state");
  fs::create_directories(path("state"));
  {
    Studio studio(own);
    read_all(studio);
  }
  Studio studio(own);
  read_all(studio);
  EXPECT_EQ(studio.session().map.words.find("3 files, 0 read anew, "), 0u) << studio.session().map.words;
}

TEST_F(StudioMap, ReadingIsCancelledAndTheMapStays) {
  Studio studio(with_coder());
  read_all(studio);
  const auto before = studio.session().map.map;
  for (int i = 0; i < 40; ++i) tests::write_walk(path("motions/more" + std::to_string(i) + ".npz"));
  studio.run("map.index", {path("motions")});
  studio.run("job.cancel", {std::to_string(studio.session().map.job)});
  studio.wait_idle();
  EXPECT_EQ(studio.session().map.map, before);
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(StudioMap, WithoutALearnedCoderComparesPoseByPose) {
  Studio studio(services());
  read_all(studio);
  EXPECT_GT(studio.session().map.map->size(), 4);
}

}  // namespace
}  // namespace understudy::app
