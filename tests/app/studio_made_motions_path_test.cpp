// A person finds an arm's bones, asks for more of its motion, keeps some, exports, saves and opens again: by
// mouse and keys.
#include "app/run/motion_generator.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/application_fixture.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy::app {
namespace {

class MadeMotionsPath : public ApplicationTest {
 protected:
  void SetUp() override {
    ApplicationTest::SetUp();
    NpyArray points;
    for (int t = 0; t < understudy::kFrames; ++t) {
      const Points frame = sparse(bent_arm(angle_at(t), static_cast<uint64_t>(t)), 1000).vertices;
      points.shape = {understudy::kFrames, frame.rows(), 3};
      points.values.insert(points.values.end(), frame.data(), frame.data() + frame.size());
    }
    write_npz(path("arm.npz"), {{"points", points}});
    make(render::ContextKind::Null, {1280, 3000});
    play("drop " + path("arm.npz") + "\nwait\nframes 3\nsource.units m\nsource.up y\nwait");
    play("key Alt+7\nframes 3\nclick bones.auto\nframes 2\n" + typed("bones.most", "2") +
         "click bones.find\nwait\nframes 3\nexpect_value bones 2");
  }
  static std::string typed(const std::string& field, const std::string& text) {
    return "click " + field + "\nkey Ctrl+A\ntype " + text + "\nkey Enter\nframes 2\n";
  }
  void make_three() {
    play(typed("generate.frames", "20") + "click generate.make\nwait\nframes 3\nexpect_value made_motions 3");
  }
};

TEST_F(MadeMotionsPath, SeedsAreKeptByClicksInTheListAndExported) {
  make_three();
  play("expect generate.offered.2\nexpect_value clips 0\nclick generate.offered.1\nframes 3");
  play("expect_value clips 1\nexpect_value undo_label \"Keep motion 2\"");
  play("key Ctrl+Z\nframes 3\nexpect_value clips 0\nexpect_value made_motions 3");
  play(
      "key Ctrl+Y\nframes 3\nexpect_value clips 1\nclick generate.offered.0\nframes 3\nexpect_value clips 2");
  play("click generate.clips.0\nframes 3\n" + typed("generate.name", "nod") +
       "expect_value undo_label \"Rename motion 2\"");
  play("click bones.export\nframes 3\n" + typed("browser.name", path("rig.glb")) + "wait");
  const Character written = read_character(path("rig.glb"));
  ASSERT_EQ(written.animations.size(), 3u);
  EXPECT_EQ(written.animations[1].name, "nod");
  EXPECT_EQ(written.animations[2].name, "motion 1");
  play("click generate.remove\nframes 3\nexpect_value clips 1\nexpect_value undo_label \"Remove nod\"");
}

TEST_F(MadeMotionsPath, ASecondBodyPerformsAClipAndIsExported) {
  make_three();
  play("click generate.offered.1\nframes 3\nclick bones.export\nframes 3\n" +
       typed("browser.name", path("second.glb")) + "wait\nframes 3");
  play("click bones.perform\nframes 3\n" + typed("browser.path", path("second.glb")) + "wait\nframes 3");
  ASSERT_TRUE(session().second.performed) << session().second.problem;
  EXPECT_EQ(session().second.performed->motion.poses.size(), static_cast<size_t>(understudy::kFrames));
  play(
      "click bones.perform_clip\nframes 3\nclick bones.perform_clip.1\nwait\nframes 3\nexpect_value "
      "undo_label \"Perform motion 2\"");
  ASSERT_TRUE(session().second.performed) << session().second.problem;
  EXPECT_EQ(session().second.performed->motion.poses.size(), 20u);
  play("click bones.perform_export\nframes 3\n" + typed("browser.name", path("nod.glb")) + "wait");
  const Character written = read_character(path("nod.glb"));
  ASSERT_EQ(written.animations.size(), 1u);
  EXPECT_EQ(written.animations[0].name, "motion 2");
  play("key Ctrl+Z\nwait\nframes 3");
  EXPECT_EQ(session().second.performed->motion.poses.size(), static_cast<size_t>(understudy::kFrames));
}

TEST_F(MadeMotionsPath, BetweenTheMarksOfTheTimelineAndCancelled) {
  make_three();
  play("playback.frame 2\nkey I\nplayback.frame 7\nkey O\nframes 2\nclick generate.between\nframes 2");
  play("click generate.make\nwait\nframes 3");
  for (const MadeMotion& one : session().made_motions.offered) {
    ASSERT_TRUE(one.how.between);
    EXPECT_EQ(one.how.between->first, 2);
    EXPECT_EQ(one.how.between->last, 7);
  }
  play(typed("generate.frames", "6000") + typed("generate.count", "12") + "click generate.make\nframes 2");
  play("click generate.work.cancel\nwait\nframes 2\nexpect_value made_motions != 0\nexpect generate.make");
  play(typed("generate.last", "300") + "frames 2");
  EXPECT_NE(complaint("click generate.make"), "") << "there is no frame 300";
}

TEST_F(MadeMotionsPath, WhatWasKeptIsThereAgainWhenTheDocumentIsOpened) {
  make_three();
  play("click generate.offered.0\nframes 3\nkey Ctrl+S\nframes 3\n" +
       typed("browser.name", path("arm.understudy")) + "wait\nexpect_value changed no");
  const auto before = session().made_motions.clips.at(0)->motion.poses;
  make(render::ContextKind::Null, {1280, 3000});
  play("drop " + path("arm.understudy") +
       "\nwait\nframes 3\nexpect_value clips 1\nexpect_value made_motions 0");
  const auto& again = session().made_motions.clips.at(0)->motion.poses;
  ASSERT_EQ(again.size(), before.size());
  for (size_t t = 0; t < again.size(); ++t) EXPECT_EQ(again[t].turns, before[t].turns) << t;
}

}  // namespace
}  // namespace understudy::app
