// The edit panel: what each control asks for.
#include <algorithm>

#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/timeline.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

class EditPanel : public PanelsTest {
 protected:
  EditPanel() {
    panel("edit");
    for (const char* closed : {"edit.target", "edit.weights"}) click(closed);
    frame(2);
  }
};

TEST_F(EditPanel, OfTheScan) {
  expect_click("edit.crop", {"edit.crop off"});
  expect_click("edit.crop_tool", {"tool crop"});
  expect_drag("edit.crop.low.x", "edit.crop low.x ");
  expect_drag("edit.crop.high.y", "edit.crop high.y ");
  expect_click("edit.floor_removal", {"edit.floor_removal off"});
  expect_drag("edit.floor_height", "edit.floor_removal on ");
  expect_click("edit.cluster", {"edit.cluster on"});
  session.document.scan_edits = ScanEdits{};
  frame(2);
  expect_click("edit.crop", {"edit.crop on"});
  expect_click("edit.floor_removal", {"edit.floor_removal on"});
  EXPECT_FALSE(shown("edit.crop.low.x"));
}

TEST_F(EditPanel, OfTheSkeleton) {
  expect_click("edit.joints_tool", {"tool joints"});
  expect_drag("edit.falloff", "tool.falloff ");
  expect_click("edit.children", {"tool.children on"});
  expect_click("edit.skeleton.0", {"playback.frame 4"});
  expect_click("edit.skeleton.1", {"playback.frame 10"});
  expect_click("edit.skeleton.1.remove", {"edit.remove skeleton 1"});
  expect_click("edit.skeleton_clear", {"edit.skeleton_clear"});
}

TEST_F(EditPanel, SwappingTakesTheLoopMarksUnlessFramesAreWritten) {
  expect_click("edit.swap.apply", {"edit.swap 5 30 both"});
  expect_click("edit.swap.limbs.0", {});
  expect_typed("edit.swap.first", "7", {});
  expect_typed("edit.swap.last", "9", {});
  expect_click("edit.swap.apply", {"edit.swap 7 9 arms"});
  session.playback.in = session.playback.out = -1;
  frame(2);
  expect_click("edit.swap.apply", {"edit.swap 20 20 arms"});
}

TEST_F(EditPanel, OfWhoIsWho) {
  EXPECT_FALSE(shown("edit.people.apply"));
  session.source.people = {{1, true, 48}, {2, true, 30}};
  frame(2);
  expect_click("edit.people.apply", {"edit.people 5 30 1 3 exchange"});
  expect_choice("edit.people.other", 1, {});
  expect_click("edit.people.apply", {"edit.people 5 30 1 2 exchange"});
  expect_typed("edit.people.first", "9", {});
  expect_typed("edit.people.last", "11", {});
  expect_click("edit.people.how.1", {});
  expect_click("edit.people.apply", {"edit.people 9 11 1 2 join"});
  session.document.source.people = {{PersonEdit::How::Join, 9, 11, 1, 2}};
  session.playback.in = session.playback.out = -1;
  frame(2);
  expect_click("edit.people.apply", {"edit.people 20 47 1 2 join"});
  expect_click("edit.people.0", {"playback.frame 9"});
  expect_click("edit.people.0.remove", {"edit.remove people 0"});
  expect_click("edit.people_clear", {"edit.people_clear"});
}

TEST_F(EditPanel, OfTheResult) {
  expect_click("edit.bones_tool", {"tool bones"});
  expect_drag("edit.bone_falloff", "tool.falloff ");
  expect_click("edit.pin", {"edit.pin 0 on"});
  expect_drag("edit.smooth", "edit.smooth 0 ");
  expect_drag("edit.raise", "edit.raise 0 ");
  expect_drag("edit.turn", "edit.turn 0 ");
  expect_click("edit.trim", {"edit.trim 0 5 30"});
  expect_click("edit.trim_off", {"edit.trim 0 off"});
  expect_click("edit.skip", {"edit.skip 0 20 on"});
  expect_click("edit.fill", {"edit.fill 0"});
  session.document.takes[0].pose_edits.fill = {{7, 9, 0.5f}};
  frame(2);
  expect_click("edit.filled.0", {"playback.frame 7"});
  expect_click("edit.filled.0.remove", {"edit.remove fill 0 0"});
  expect_drag("edit.fill_learned.0", "edit.fill_learned 0 0 ");
  expect_click("edit.fill_variation.0.2", {"edit.fill_variation 0 0 2"});
  expect_click("edit.rotation.0", {"playback.frame 12"});
  expect_click("edit.rotation.0.remove", {"edit.remove rotation 0 0"});
  expect_click("edit.poses_clear", {"edit.poses_clear 0"});
}

TEST_F(EditPanel, GoesOnAndLoops) {
  expect_click("edit.go_on", {"edit.go_on"});
  expect_click("edit.loop", {"edit.loop"});
  EXPECT_FALSE(shown("edit.gone_on"));
  EXPECT_FALSE(shown("edit.looped"));
  session.document.takes[0].pose_edits.go_on = GoOnEdit{1.5f, 0.5f};
  session.document.takes[0].pose_edits.loop = LoopEdit{8, 36, 0.2f, 0.5f};
  frame(2);
  const std::string there = std::to_string(session.takes[0].performed.size());
  expect_click("edit.gone_on", {"playback.frame " + there});
  expect_click("edit.gone_on.remove", {"edit.remove go_on 0"});
  expect_drag("edit.go_on_learned", "edit.go_on_learned 0 ");
  expect_click("edit.go_on_variation.3", {"edit.go_on_variation 0 3"});
  expect_click("edit.looped", {"playback.frame 8"});
  expect_click("edit.looped.remove", {"edit.remove loop 0"});
  expect_drag("edit.loop_learned", "edit.loop_learned 0 ");
}

TEST_F(EditPanel, ALineOfAFillSaysHowFarItMayBeOff) {
  session.document.takes[0].pose_edits.fill = {{7, 9}, {12, 12}};
  const auto words = [&](const std::string& name) {
    frame(2);
    const auto said = gui.ui().explanation_at(mark(name).rect.at(0.5f, 0.5f));
    return said ? said->text : "";
  };
  EXPECT_EQ(words("edit.filled.0"), "Frames 7 to 9 filled. Click: go there") << "not made yet";
  session.takes[0].shown.doubt_m.assign(13, 0.f);
  session.takes[0].shown.doubt_m[8] = 0.024f, session.takes[0].shown.doubt_m[12] = 0.007f;
  EXPECT_EQ(words("edit.filled.0"), "Frames 7 to 9 filled, \u00b1 3 cm. Click: go there");
  EXPECT_EQ(words("edit.filled.1"), "Frame 12 filled, \u00b1 1 cm. Click: go there");
}

TEST_F(EditPanel, AHandThatWasMovedIsOneEntry) {
  auto& rotate = session.document.takes[0].pose_edits.rotate;
  for (const int frame : {14, 16})
    for (const int joint : {LeftShoulder, LeftElbow, LeftWrist})
      rotate.push_back({frame, joint, Vec3(0.1f, 0, 0), 5, LeftWrist});
  frame(2);
  EXPECT_TRUE(shown("edit.rotation.0")) << "an elbow turned by itself";
  for (const char* of_the_first : {"edit.rotation.2", "edit.rotation.3"}) EXPECT_FALSE(shown(of_the_first));
  expect_click("edit.rotation.1", {"playback.frame 14"});
  expect_click("edit.rotation.1.remove", {"edit.remove limb 0 14 left_wrist"});
  expect_click("edit.rotation.4.remove", {"edit.remove limb 0 16 left_wrist"});
  const std::vector<EditMark> marks = edit_marks(session, {});
  const auto at = std::find_if(marks.begin(), marks.end(),
                               [](const EditMark& edit) { return edit.mark.name == "rotations.14"; });
  ASSERT_NE(at, marks.end());
  EXPECT_EQ(at->mark.words, "Moved: left hand");
}

TEST_F(EditPanel, OfTheTarget) {
  expect_click("edit.target_tool", {"tool target-joints"});
  expect_click("edit.mirror", {"tool.mirror off"});
  expect_click("edit.moved.0.remove", {"edit.remove joint 0 0"});
  expect_click("edit.target_joints_clear", {"edit.target_joints_clear 0"});
}

TEST_F(EditPanel, OfTheWeights) {
  expect_click("edit.paint_tool", {"tool paint"});
  expect_choice("edit.joint", 15, {"select.joint head"});
  expect_drag("edit.brush_radius", "tool.brush_radius ");
  expect_drag("edit.brush_strength", "tool.brush_strength ");
  expect_click("edit.brush_mode.2", {"tool.brush_mode smooth"});
  expect_click("edit.weights_mirror.left", {"edit.weights_mirror 0 left"});
  expect_click("edit.weights_mirror.right", {"edit.weights_mirror 0 right"});
  expect_click("edit.weights_smooth", {"edit.weights_smooth 0 0.5"});
  expect_click("edit.weights_clear", {"edit.weights_clear 0"});
}

TEST_F(EditPanel, ATakenToolIsPutBackByItsButton) {
  session.tool = app::Tool::Bones;
  frame(2);
  expect_click("edit.bones_tool", {"tool look"});
}

TEST_F(EditPanel, WithoutEditsThereIsNothingToClear) {
  session.document.skeleton_edits.clear();
  session.document.takes[0].pose_edits = PoseEdits{};
  session.document.takes[0].target_edits = app::TargetEdits{};
  session.playback.in = session.playback.out = -1;
  frame(2);
  for (const char* name : {"edit.skeleton_clear", "edit.poses_clear", "edit.target_joints_clear",
                           "edit.weights_clear", "edit.trim", "edit.trim_off"})
    EXPECT_FALSE(mark(name).enabled) << name;
}

}  // namespace
}  // namespace understudy::ui
