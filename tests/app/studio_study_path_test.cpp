// A person designs a study in the window with mouse and keys.
#include <gtest/gtest.h>

#include "app/study/trials.hpp"
#include "tests/app/application_fixture.hpp"

namespace understudy::app {
namespace {

class StudyPath : public ApplicationTest {
 protected:
  /// A window high enough for the whole panel, with two takes of one target.
  void open_two_takes() {
    make(render::ContextKind::Null, {1280, 1900});
    play(kOpenBoth);
    play("click menu.target\nclick menu.compare.add\nclick compare.engine.1\nclick compare.apply\nwait");
  }
  void begin_study() {
    play(
        "click menu.study\nhover menu.New\nclick menu.study.new.takes\nframes 3\nclick study.add_likert\n"
        "frames 3");
  }
  void type_into(const std::string& field, const std::string& text) {
    play("click " + field + "\nkey Ctrl+A\ntype \"" + text + "\"\nkey Enter\nframes 3");
  }
  const StudyState& state() const { return session().study; }
};

TEST_F(StudyPath, FromTheOpenTakesToAFile) {
  open_two_takes();
  play("click menu.study\nhover menu.New\nclick menu.study.new.takes\nframes 3\nexpect study.problem");
  ASSERT_TRUE(state().study);
  EXPECT_EQ(state().problem, "the study has no question");
  play(
      "click study.add_likert\nframes 3\nexpect study.size\nexpect_no study.problem\nexpect_value "
      "study_trials 2");
  type_into("study.conditions.0.name", "Ours");
  EXPECT_EQ(state().study->conditions[0].name, "Ours");
  const double minutes = state().minutes;
  play("click study.add_attention\nframes 3\nexpect_value study_trials 2");
  EXPECT_GT(state().minutes, minutes) << "one more question takes longer";
  play("click study.question.0\nframes 3");
  type_into("study.questions.0.points", "5");
  EXPECT_EQ(state().study->questions[0].points, 5);
  play("click study.plan\nframes 3");
  type_into("study.plan.repetitions", "3");
  play("expect_value study_trials 6");
  play("key Ctrl+Z\nframes 3\nexpect_value study_trials 2\nexpect_value undo_label \"Change points\"");
  play("key Ctrl+Shift+Z\nframes 3\nexpect_value study_trials 6");
  play("click study.save\nclick browser.name\nkey Ctrl+A\ntype \"" + path("mine.study") +
       "\"\nkey Enter\nframes 3\nexpect_value study_changed no");
  const Study saved = read_study(path("mine.study"));
  EXPECT_EQ(saved.conditions[0].name, "Ours");
  EXPECT_EQ(saved.questions[0].points, 5);
  EXPECT_EQ(saved.plan.repetitions, 3);
  EXPECT_EQ(trial_count(saved), 6);
}

TEST_F(StudyPath, WhatIsWrongIsSaidAndTheStudyStaysEditable) {
  open_two_takes();
  begin_study();
  type_into("study.conditions.0.name", "Paper");
  play("expect study.problem\nexpect_no study.size");
  EXPECT_NE(state().problem.find("Paper"), std::string::npos) << state().problem;
  type_into("study.conditions.0.name", "Ours");
  play("expect study.size\nexpect_no study.problem\nclick study.trial.1\nframes 2");
  EXPECT_EQ(chosen(state(), StudyList::Trial), 1);
  play("click study.condition.remove\nframes 3\nexpect study.problem");
  EXPECT_EQ(state().problem, "the study has one condition: it needs two to compare");
}

TEST_F(StudyPath, OpensAPresetWithNothingElseOpen) {
  make(render::ContextKind::Null, {1280, 1900});
  play(
      "click menu.study\nhover menu.New\nclick menu.study.new.rekik\nframes 3\nexpect_value study_trials 45");
  play("expect study.size\nexpect start.open_source\nexpect study.gone\nexpect_value undo_label \"\"");
  type_into("study.participant", "P4");
  EXPECT_EQ(state().trials.size(), 48u);
}

TEST_F(StudyPath, AsksBeforeAnUnsavedStudyIsLost) {
  make(render::ContextKind::Null, {1280, 1900});
  play("click menu.study\nhover menu.New\nclick menu.study.new.dong\nframes 3\nkey Ctrl+Q\nframes 3");
  play("expect unsaved.yes\nexpect_value question unsaved-study\nclick unsaved.cancel\nframes 3");
  EXPECT_FALSE(session().quit);
  play("key Ctrl+Q\nframes 3\nclick unsaved.yes\nframes 3\nclick browser.name\nkey Ctrl+A\ntype \"" +
       path("dong.study") + "\"\nkey Enter\nframes 3");
  EXPECT_TRUE(session().quit);
  EXPECT_EQ(read_study(path("dong.study")).name, "Dong et al. 2020");
}

TEST_F(StudyPath, ADroppedStudyIsOpenedAndRemembered) {
  open_two_takes();
  begin_study();
  play("study.save_as " + path("mine.study") + "\nstudy.close\nframes 2\nexpect study.new");
  play("drop " + path("mine.study") + "\nframes 3\nexpect study.size\nexpect_value study_changed no");
  EXPECT_EQ(state().path, path("mine.study"));
  EXPECT_EQ(session().settings.recent_studies.front(), path("mine.study"));
}

TEST_F(StudyPath, AnAnimationIsAddedToTheChosenCondition) {
  open_two_takes();
  begin_study();
  play(
      "click study.condition.1\nframes 2\nclick study.conditions.1.kind\nclick "
      "study.conditions.1.kind.1\nframes 3");
  play("expect study.problem\nclick study.add_animation\nframes 2\ntype \"" + path("scan.npz") +
       "\"\nkey Enter\nframes 3");
  ASSERT_EQ(state().study->conditions[1].files.size(), 1u);
  EXPECT_EQ(state().study->conditions[1].files[0].path, path("scan.npz"));
  EXPECT_EQ(state().problem, "");
}

}  // namespace
}  // namespace understudy::app
