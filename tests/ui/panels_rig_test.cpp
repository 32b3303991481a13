// The section "Rig" of the inspector: which bone is which joint, and what a click on it asks for.
#include "tests/retarget/character/characters.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/rig.hpp"

namespace understudy::ui {
namespace {

class RigPanel : public PanelsTest {
 protected:
  RigPanel() {
    tests::MadeCharacter made;
    made.arms_down_deg = 50;
    session.takes[0].character = std::make_shared<const PreparedCharacter>(
        prepare_character(tests::make_character(made), nullptr, nullptr));
    panel([this] { draw_rig(session, context); });
  }
};

TEST_F(RigPanel, TheRigIsChosen) {
  expect_click("rig.choice.1", {"target.rig 0 own"});
  expect_click("rig.choice.2", {"target.rig 0 22"});
  session.document.takes[0].target.rig = app::Rig::Ours;
  frame(2);
  expect_click("rig.choice.0", {"target.rig 0 auto"});
}

TEST_F(RigPanel, AJointIsSelectedInTheTable) {
  EXPECT_FALSE(shown("rig.joint.4"));
  click("inspector.bones");
  frame(6);
  expect_click("rig.joint.4", {"select.joint left_knee"});
  session.selected_joint = LeftKnee;
  frame(6);
  expect_click("rig.joint.4", {"select.joint none"});
}

TEST_F(RigPanel, TheSelectedJointGetsABone) {
  click("inspector.bones");
  frame(2);
  expect_click("rig.bone.0", {"target.bone 0 left_wrist auto"});
  expect_click("rig.bone.1", {"target.bone 0 left_wrist none"});
  write_into("rig.bone.search", "RightHand");
  key(render::Key::Enter);
  const std::vector<std::string> lines = asked();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], "target.bone 0 left_wrist " + tests::made_name(tests::Naming::Mixamo, RightWrist));
}

TEST_F(RigPanel, ResetIsThereOnceSomethingWasChosen) {
  click("inspector.bones");
  frame(2);
  EXPECT_FALSE(mark("rig.reset").enabled);
  session.document.takes[0].target.bones["head"] = "";
  frame(2);
  expect_click("rig.reset", {"target.bones_clear 0"});
}

TEST_F(RigPanel, WithoutACharacterOnlyTheChoiceIsThere) {
  session.selected_take = 1;
  frame(2);
  EXPECT_TRUE(shown("rig.choice.0"));
  EXPECT_FALSE(shown("inspector.bones"));
}

}  // namespace
}  // namespace understudy::ui
