// How the selected target performs: its style, and the dialog that teaches one.
#include "tests/ui/support/panels_test.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

app::TaughtStyle mine() {
  app::TaughtStyle style;
  style.note = {"mine", "mine", "Moves like this", "own recordings", "", "recordings"};
  style.file = "/home/me/my styles/mine.json";
  return style;
}

class PerformanceSection : public PanelsTest {
 protected:
  PerformanceSection() {
    session.styles.taught = {mine()};
    panel("inspector");
  }
};

TEST_F(PerformanceSection, TaughtStylesAreListedBehindThoseOfTheProgram) {
  expect_choice("performance.style", 1, {"method.style 0 child"});
  expect_choice("performance.style", 5, {"method.style 0 \"/home/me/my styles/mine.json\""});
  session.document.takes[0].method.style.choose("/home/me/my styles/mine.json");
  frame(2);
  click("performance.style");
  frame(2);
  EXPECT_FALSE(shown("performance.style.6")) << "it is in the list once";
}

TEST_F(PerformanceSection, AStyleIsTaughtAndMeanwhileItsJobIsShown) {
  expect_click("performance.teach", {"dialog.open teach_style"});
  session.jobs = {{9, "Teaching mine", 0.5f, 3, true, "recording 3 of 6"}};
  session.styles.job = 9;
  frame(2);
  EXPECT_FALSE(shown("performance.teach"));
  expect_click("performance.teaching.cancel", {"job.cancel 9"});
}

TEST_F(PerformanceSection, ItTellsWhatIsSeenBesideATakeOfAnotherTempo) {
  ASSERT_EQ(session.document.takes.size(), 2u);
  click("inspector.tempo");
  frame(2);
  EXPECT_FALSE(shown("tempo.beside"));
  session.document.takes[1].pose_edits.tempo = TempoEdit{};
  frame(2);
  EXPECT_TRUE(shown("tempo.beside"));
  session.document.takes.resize(1);
  frame(2);
  EXPECT_FALSE(shown("tempo.beside"));
}

class TeachDialog : public WorkspaceTest {
 protected:
  TeachDialog() {
    session.styles.taught = {mine()};
    workspace.open_dialog(session, "teach_style");
    frame(3);
  }
  void fill(const std::string& name) {
    write_into("teach_style.from", "/data/adults");
    write_into("teach_style.to", "/data/children");
    write_into("teach_style.name", name);
    frame(2);
  }
};

TEST_F(TeachDialog, AsksForWhatWasFilledIn) {
  EXPECT_FALSE(mark("teach_style.apply").enabled);
  EXPECT_TRUE(shown("teach_style.consent"));
  fill("as they do");
  write_into("teach_style.licence", "CC BY-NC 4.0");
  click("teach_style.joints");
  frame(2);
  click("teach_style.joints.2");
  frame(2);
  click("teach_style.apply");
  EXPECT_EQ(take_log(), Lines{"style.teach /data/adults /data/children \"as they do\" "
                              "\"licence=CC BY-NC 4.0\" joints=upper-body"});
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(TeachDialog, ANameThatIsNoneOrTakenIsToldAtOnce) {
  fill("Child");
  EXPECT_TRUE(shown("teach_style.problem"));
  EXPECT_FALSE(mark("teach_style.apply").enabled);
  write_into("teach_style.name", "mine");
  frame(2);
  EXPECT_FALSE(shown("teach_style.problem"));
  EXPECT_FALSE(mark("teach_style.apply").enabled) << "there is one of that name";
  EXPECT_FALSE(shown("teach_style.restore"));
  click("teach_style.forget");
  EXPECT_EQ(take_log(), Lines{"style.forget mine"});
  click("teach_style.replace");
  frame(2);
  click("teach_style.apply");
  EXPECT_EQ(take_log(),
            Lines{"style.teach /data/adults /data/children mine \"licence=own recordings\" replace=1"});
}

TEST_F(TeachDialog, AForgottenStyleIsOfferedBackUnderItsName) {
  session.styles.taught.clear();
  session.styles.forgotten = app::ForgottenStyle{"mine", "/home/me/my styles/mine.json", "{}"};
  fill("another");
  EXPECT_FALSE(shown("teach_style.restore"));
  write_into("teach_style.name", "mine");
  frame(2);
  EXPECT_FALSE(shown("teach_style.forget"));
  click("teach_style.restore");
  EXPECT_EQ(take_log(), Lines{"style.restore mine"});
}

TEST_F(TeachDialog, WhatAFolderHoldsIsToldOnceItIsTyped) {
  write_into("teach_style.from", US_SOURCE_DIR "/assets/samples/scan");
  EXPECT_FALSE(shown("teach_style.from.holds")) << "it may be typed on";
  for (int i = 0; i < 2000 && !shown("teach_style.from.holds"); ++i) frame(1);
  EXPECT_TRUE(shown("teach_style.from.holds"));
  EXPECT_FALSE(shown("teach_style.to.holds"));
  write_into("teach_style.licence", "CC BY 4.0");
  write_into("teach_style.attribution", "Somebody");
  fill("as they do");
  click("teach_style.apply");
  EXPECT_EQ(take_log(), Lines{"style.teach /data/adults /data/children \"as they do\" \"licence=CC BY 4.0\" "
                              "attribution=Somebody"});
}

TEST_F(TeachDialog, AFolderIsChosenAndTheDialogComesBack) {
  click("teach_style.to.browse");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "files");
  click("browser.cancel");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "teach_style");
  click("teach_style.cancel");
  EXPECT_EQ(workspace.dialog(), "");
  EXPECT_TRUE(take_log().empty());
}

TEST_F(TeachDialog, WhatFailsComesBackWithAllItsChoices) {
  fill("as they do");
  click("teach_style.apply");
  const Lines asked_for = take_log();
  ASSERT_EQ(asked_for.size(), 1u);
  session.errors.push_back(
      {app::Notice::Kind::Error, "/data/adults: there is no such folder", asked_for[0], 0});
  frame(3);
  click("error.close");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "teach_style");
  EXPECT_TRUE(mark("teach_style.apply").enabled);
}

}  // namespace
}  // namespace understudy::ui
