// The second body's section of the panel Bones with mouse and keys.
#include "app/run/rig_performance.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "tests/ui/support/three_bones.hpp"
#include "ui/panels/files.hpp"

namespace understudy::ui {
namespace {

class SecondBodyPanel : public PanelsTest {
 protected:
  SecondBodyPanel() {
    input.size = {380, 1900};
    session.jobs.clear();
    session.working = false;
    session.document.bones.wanted = true;
    session.bones.rig = three_bones();
  }
  /// A body whose leg performs as the paw; nobody performs as the leg.
  void show_second() {
    session.document.bones.second = {"/a/pony.glb", {{"paw", "shin"}}};
    auto other = std::make_shared<app::LaidOther>();
    other->body = session.bones.rig->found;
    other->body.rig.joints[1].name = "shin", other->body.rig.joints[2].name = "hoof";
    other->laid.scale = 0.8f;
    session.second.other = other;
    session.second.matches = {{0, 2, -1}, {0.1f, 0.93f, 0}};
    session.second.performed = std::make_shared<const RiggedMotion>(other->body);
    panel("bones");
  }
};

TEST_F(SecondBodyPanel, AsksForAFile) {
  panel("bones");
  expect_click("bones.perform", {"dialog.open second_body"});
  EXPECT_TRUE(purpose_of("second_body").has_value());
  EXPECT_FALSE(shown("bones.perform_export") || shown("bones.perform_drop"));
}

TEST_F(SecondBodyPanel, EachBonesMatchIsChosenFromAList) {
  show_second();
  expect_choice("bones.match.1", 4, {"bones.match 1 2"});
  expect_choice("bones.match.2", 1, {"bones.match 2 none"});
  expect_choice("bones.match.2", 0, {"bones.match 2 auto"});
  EXPECT_FALSE(shown("bones.match.3"));
}

TEST_F(SecondBodyPanel, WhatItPerformsIsChosenAmongTheClips) {
  show_second();
  EXPECT_FALSE(shown("bones.perform_clip"));
  session.document.bones.clips = {{"nod", {}}};
  frame(2);
  expect_choice("bones.perform_clip", 1, {"bones.perform_clip nod"});
  session.document.bones.second.clip = "nod";
  frame(2);
  expect_choice("bones.perform_clip", 0, {"bones.perform_clip motion"});
}

TEST_F(SecondBodyPanel, IsExportedAndDropped) {
  show_second();
  expect_click("bones.perform_export", {"dialog.open export_second_body"});
  EXPECT_TRUE(purpose_of("export_second_body").has_value());
  expect_click("bones.perform_drop", {"bones.perform_drop"});
  expect_click("bones.perform", {"dialog.open second_body"});
}

TEST_F(SecondBodyPanel, TellsHowFarItIsAndIsCancelled) {
  session.document.bones.second.path = "/a/scans";
  session.second.job = 7, session.second.stage = "Surface", session.second.share = 0.2f;
  session.jobs = {{7, "Second body performs", 0.2f, 30, true}};
  panel("bones");
  expect_click("bones.perform.work.cancel", {"job.cancel 7"});
  EXPECT_FALSE(shown("bones.match.0"));
}

TEST_F(SecondBodyPanel, OneScanHasNoMatchesToChoose) {
  show_second();
  auto scan = std::make_shared<app::LaidOther>(*session.second.other);
  scan->is_scan = true;
  session.second.other = scan;
  frame(2);
  EXPECT_FALSE(shown("bones.match.0"));
  EXPECT_TRUE(shown("bones.perform_export"));
}

}  // namespace
}  // namespace understudy::ui
