// A take goes on beyond its last captured frame, or plays in a loop.
#include <cmath>

#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

class MadeFramesOfATake : public StudioTest {
 protected:
  static const Motion& shown(const Studio& studio) { return studio.session().takes.at(0).shown; }
  static bool equal(const Pose& a, const Pose& b) { return a.local == b.local && a.root == b.root; }
  static bool is_told(const Studio& studio, const std::string& words) {
    for (const Notice& notice : studio.session().notices)
      if (notice.text.find(words) != std::string::npos) return true;
    return false;
  }
};

TEST_F(MadeFramesOfATake, GoOnBeyondTheLastOne) {
  Studio studio(services());
  open_both(studio);
  const std::vector<Pose> captured = shown(studio).poses;
  studio.run("edit.go_on", {"0", "0.5"});
  studio.wait_idle();
  const Session& session = studio.session();
  const TakeState& take = session.takes[0];
  const size_t more = 15;
  ASSERT_EQ(shown(studio).poses.size(), kFrames + more);
  EXPECT_EQ(frame_count(session), kFrames + static_cast<int>(more));
  EXPECT_EQ(take.joints.size(), kFrames + more);
  EXPECT_EQ(take.performed.size(), size_t{kFrames}) << "what is made is no performance";
  EXPECT_EQ(session.source.frames.size(), size_t{kFrames});
  for (size_t t = 0; t < kFrames + more; ++t) {
    EXPECT_EQ(shown(studio).doubt_m[t] > 0, t >= kFrames) << t;
    if (t < kFrames) EXPECT_TRUE(equal(shown(studio).poses[t], captured[t])) << t;
  }
  EXPECT_TRUE(is_told(studio, "frames 24 to 38 are a guess: nothing after them is known"));
  EXPECT_EQ(undo_label(session), "Go on for 0.5 s");
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), size_t{kFrames});
  EXPECT_TRUE(same_poses(shown(studio), Motion{30, captured, {}}));
}

TEST_F(MadeFramesOfATake, GoOnASecondLongerEachTimeAndNoLonger) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.go_on");
  studio.run("edit.go_on");
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), size_t{kFrames + 60});
  studio.run("edit.go_on_learned", {"0", "0"});
  studio.wait_idle();
  const float plain = shown(studio).poses[kFrames + 5].root.y();
  studio.run("edit.go_on_learned", {"0", "1"});
  studio.wait_idle();
  EXPECT_NEAR(shown(studio).poses[kFrames + 5].root.y() - plain, LiftedSpace::kLift_m, 1e-4f);
  studio.run("edit.go_on", {"0", "off"});
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), size_t{kFrames});
  EXPECT_THROW(studio.run("edit.go_on_learned", {"0", "1"}), Error);
  EXPECT_THROW(studio.run("edit.go_on", {"0", "0"}), Error);
  EXPECT_THROW(studio.run("edit.go_on", {"0", "61"}), Error);
  EXPECT_THROW(studio.run("edit.go_on", {"0", "soon"}), Error);
  EXPECT_THROW(studio.run("edit.go_on", {"1", "1"}), Error);
}

TEST_F(MadeFramesOfATake, GoOnByOneOfFourFutures) {
  Studio studio(services());
  open_both(studio);
  EXPECT_THROW(studio.run("edit.go_on_variation", {"0", "1"}), Error) << "it does not go on";
  studio.run("edit.go_on", {"0", "0.5"});
  studio.wait_idle();
  const float best = shown(studio).poses[kFrames + 5].root.y();
  studio.run("edit.go_on_variation", {"0", "1"});
  studio.wait_idle();
  EXPECT_NEAR(shown(studio).poses[kFrames + 5].root.y() - best, LiftedSpace::kAlternativeLift_m, 1e-5f);
  EXPECT_EQ(undo_label(studio.session()), "Go on by alternative 2");
  const auto& alternatives = studio.session().takes[0].alternatives;
  ASSERT_EQ(alternatives.size(), size_t{kMostVariations});
  EXPECT_EQ(alternatives[3].size(), size_t{kFrames + 15});
  EXPECT_EQ(alternatives[1], studio.session().takes[0].joints) << "the chosen one";
  studio.run("edit.go_on", {"0", "0.7"});
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.go_on->variation, 1) << "longer by the same";
  EXPECT_THROW(studio.run("edit.go_on_variation", {"0", "4"}), Error);
}

TEST_F(MadeFramesOfATake, HaveNoFiguresAndTheOthersKeepTheirs) {
  Studio studio(services());
  open_both(studio);
  const std::vector<Series> before = studio.session().takes[0].series;
  const Metrics metrics = studio.session().takes[0].metrics;
  ASSERT_FALSE(before.empty());
  ASSERT_FALSE(metrics.empty());
  studio.run("edit.go_on", {"0", "0.5"});
  studio.wait_idle();
  const std::vector<Series>& now = studio.session().takes[0].series;
  for (const Series& old : before) {
    const Series* const series = find(now, old.key);
    ASSERT_NE(series, nullptr) << old.key;
    ASSERT_EQ(series->values.size(), old.values.size() + 15) << old.key;
    for (size_t t = 0; t < series->values.size(); ++t) {
      const float is = series->values[t];
      if (t >= old.values.size())
        EXPECT_TRUE(std::isnan(is)) << old.key << " " << t;
      else
        EXPECT_TRUE(is == old.values[t] || (std::isnan(is) && std::isnan(old.values[t]))) << old.key << t;
    }
  }
  EXPECT_EQ(studio.session().takes[0].metrics, metrics) << "of what was captured";
}

TEST_F(MadeFramesOfATake, AreExportedAndTold) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.go_on", {"0", "0.5"});
  studio.wait_idle();
  const auto inputs = export_inputs(studio.session(), {0}, {});
  ASSERT_EQ(inputs.at(0).clips.at(0).poses.size(), size_t{kFrames + 15});
  EXPECT_EQ(inputs[0].source_joints.size(), size_t{kFrames + 15});
  EXPECT_EQ(inputs[0].source_joints.back(), inputs[0].source_joints[kFrames - 1]) << "it has stopped";
  const auto& made = inputs[0].clips[0].made;
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].first, kFrames);
  EXPECT_EQ(made[0].last, kFrames + 14);
  EXPECT_GT(made[0].doubt_m, 0);
}

TEST_F(MadeFramesOfATake, FollowTheLastFrameWhereAllAreMadeAnew) {
  Studio studio(services());
  studio.run("open", {path("scan.npz")});
  studio.run("open", {path("target.obj")});
  while (studio.session().takes[0].performed.empty()) studio.tick(0.01);
  studio.run("edit.go_on", {"0", "0.5"});  // maybe before the last one is there
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), size_t{kFrames + 15});
  studio.run("method.engine", {"0", "paper"});
  studio.wait_idle();
  ASSERT_EQ(shown(studio).poses.size(), size_t{kFrames + 15});
  EXPECT_GT(shown(studio).doubt_m.back(), 0);
  EXPECT_EQ(shown(studio).doubt_m[kFrames - 1], 0);
}

TEST_F(MadeFramesOfATake, CanBeShortenedAndRemovedInTheTimelineButNotFilled) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.go_on", {"0", "1"});
  studio.wait_idle();
  studio.run("edit.move", {"go_on", "0", "24", "33"});
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), 34u);
  EXPECT_THROW(studio.run("edit.fill", {"0", "20", "30"}), Error) << "they are made already";
  studio.run("edit.rotate", {"0", "28", "left_elbow", "1", "0", "0", "3"});
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), 34u) << "made frames can be edited";
  studio.run("edit.remove", {"go_on", "0"});
  studio.wait_idle();
  EXPECT_EQ(shown(studio).poses.size(), size_t{kFrames});
  EXPECT_THROW(studio.run("edit.move", {"go_on", "0", "24", "33"}), Error);
}

TEST_F(MadeFramesOfATake, AreSavedAndOpenedAgainToTheBit) {
  Motion saved;
  {
    Studio studio(services());
    open_walk(studio);
    studio.run("edit.loop");
    studio.run("edit.go_on", {"0", "0.7"});
    studio.wait_idle();
    studio.run("document.save_as", {path("made.understudy")});
    saved = shown(studio);
  }
  Studio studio(services());
  studio.run("document.open", {path("made.understudy")});
  studio.wait_idle();
  ASSERT_EQ(shown(studio).poses.size(), saved.poses.size());
  EXPECT_TRUE(same_poses(shown(studio), saved));
  EXPECT_EQ(shown(studio).doubt_m, saved.doubt_m);
}

TEST_F(MadeFramesOfATake, OfALoopCloseItsSeam) {
  Studio studio(services());
  open_walk(studio);
  studio.run("edit.loop");
  studio.wait_idle();
  const auto edits = [&]() -> const PoseEdits& { return studio.session().document.takes[0].pose_edits; };
  ASSERT_TRUE(edits().loop && edits().trim);
  const LoopEdit loop = *edits().loop;
  EXPECT_EQ(edits().trim->first, loop.first);
  EXPECT_EQ(edits().trim->last, loop.last);
  EXPECT_TRUE(is_told(studio, "play in a loop"));
  const Motion& motion = shown(studio);
  for (int joint = 1; joint < kJointCount; ++joint)
    EXPECT_LT(geodesic_angle(motion.poses[loop.first].local[joint], motion.poses[loop.last].local[joint]),
              1e-3f);
  EXPECT_GT(motion.doubt_m[loop.first + 2], 0);
  EXPECT_EQ(motion.doubt_m[(loop.first + loop.last) / 2], 0);
  const auto inputs = export_inputs(studio.session(), {0}, {});
  EXPECT_EQ(inputs.at(0).clips.at(0).poses.size(), static_cast<size_t>(loop.last - loop.first + 1));
  EXPECT_EQ(inputs[0].clips[0].made.size(), 2u);
  EXPECT_EQ(studio.session().history.undo_label().find("Loop frames "), 0u);
  studio.run("edit.loop", {"0", "off"});
  studio.wait_idle();
  EXPECT_FALSE(edits().loop || edits().trim);
  EXPECT_TRUE(shown(studio).doubt_m.empty() || shown(studio).doubt_m[loop.first + 2] == 0);
  studio.run("edit.undo");
  studio.run("edit.remove", {"loop", "0"});
  EXPECT_FALSE(edits().loop || edits().trim);
}

TEST_F(MadeFramesOfATake, LoopBetweenTheMarksOrSayWhyNot) {
  Studio studio(services());
  open_walk(studio);
  studio.run("playback.in", {"20"});
  studio.run("playback.out", {"90"});
  studio.run("edit.loop");
  const LoopEdit loop = *studio.session().document.takes[0].pose_edits.loop;
  EXPECT_GE(loop.first, 20);
  EXPECT_LE(loop.last, 90);
  studio.run("edit.loop_learned", {"0", "0.25"});
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.loop->learned, 0.25f);
  EXPECT_EQ(failure_of([&] {
              studio.run("edit.loop", {"0", "20", "28"});
            }),
            "no two moments of frames 20 to 28 are alike: there is no loop in them");
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.loop->first, loop.first) << "nothing has changed";
  EXPECT_THROW(studio.run("edit.loop", {"0", "20", "900"}), Error);
  EXPECT_THROW(studio.run("edit.loop", {"3"}), Error);
  studio.run("edit.loop", {"0", "off"});
  EXPECT_THROW(studio.run("edit.loop_learned", {"0", "1"}), Error);
}

}  // namespace
}  // namespace understudy::app
