// The study panel: what each control asks for.
#include <filesystem>

#include "app/session/study_edits.hpp"
#include "app/study/presets.hpp"
#include "tests/ui/support/panels_test.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

class StudyPanel : public PanelsTest {
 protected:
  StudyPanel() {
    session.study.study = app::study_preset("dong").make("/samples");
    session.study.study->conditions.push_back(
        {"theirs", app::ConditionKind::Files, {}, {{"", "", "/a/one.glb"}}});
    app::follow_design(session.study);
    panel("study");
    input.size.height = 5000;
    for (const char* closed : {"study.motions", "study.targets", "study.options", "study.layout",
                               "study.clip", "study.picture_section", "study.plan", "study.words"})
      click(closed);
    frame(2);
  }
  app::StudyState& state() { return session.study; }
  void choose(app::StudyList list, int i) {
    state().chosen[static_cast<size_t>(list)] = i;
    frame(2);
  }
};

TEST_F(StudyPanel, OfConditions) {
  expect_click("study.condition.2", {"study.choose condition 2"});
  expect_typed("study.conditions.0.name", "Ours", {"study.set conditions.0.name Ours"});
  expect_click("study.conditions.0.method.engine.1", {"study.set conditions.0.method.engine paper"});
  expect_click("study.conditions.0.method.offsets", {"study.set conditions.0.method.offsets off"});
  expect_click("study.conditions.0.method.lock_feet", {"study.set conditions.0.method.lock_feet off"});
  expect_drag("study.conditions.0.method.stride", "study.set conditions.0.method.stride ");
  expect_click("study.condition.down", {"study.move condition 0 1"});
  expect_click("study.condition.copy", {"study.copy condition 0"});
  expect_click("study.condition.remove", {"study.remove condition 0"});
  EXPECT_FALSE(mark("study.condition.up").enabled);
  expect_click("study.add_conditions", {"study.add_conditions"});
  expect_click("study.add_files", {"dialog.open study_files"});
}

TEST_F(StudyPanel, OfAConditionOfAnimations) {
  choose(app::StudyList::Condition, 5);
  EXPECT_FALSE(shown("study.conditions.5.method.engine"));
  expect_choice("study.conditions.5.files.0.motion", 2, {"study.set conditions.5.files.0.motion dance"});
  expect_choice("study.conditions.5.files.0.target", 1, {"study.set conditions.5.files.0.target adult"});
  expect_click("study.file.0.remove", {"study.remove_file 5 0"});
  expect_click("study.add_animation", {"dialog.open study_animation"});
  expect_choice("study.conditions.5.kind", 2, {"study.set conditions.5.kind ground-truth"});
}

TEST_F(StudyPanel, OfMotionsAndTargets) {
  expect_typed("study.motions.0.action", "Strolling", {"study.set motions.0.action Strolling"});
  expect_typed("study.motions.0.seconds", "2.5", {"study.set motions.0.seconds 2.5"});
  expect_drag("study.motions.0.from_s", "study.set motions.0.from_s ");
  expect_click("study.add_source", {"study.add_motion"});
  expect_click("study.add_motion", {"dialog.open study_motion"});
  EXPECT_FALSE(shown("study.add_blends"));
  session.document.source.blend = app::BlendRecipe{{{"/a/walk.bvh"}, {"/a/run.npz"}}};
  frame(2);
  expect_click("study.add_blends", {"study.add_blends 7"});
  expect_typed("study.targets.0.name", "grown", {"study.set targets.0.name grown"});
  expect_typed("study.targets.0.target.import.height_m", "1.6",
               {"study.set targets.0.target.import.height_m 1.6"});
  state().study->targets[0].target.import.height = 1.6f;
  frame(2);
  expect_typed("study.targets.0.target.import.height_m", "auto",
               {"study.set targets.0.target.import.height_m none"});
  expect_click("study.add_targets", {"study.add_target"});
  expect_click("study.add_target", {"dialog.open study_target"});
}

TEST_F(StudyPanel, OfQuestions) {
  expect_typed("study.questions.0.text", "Who is it?", {"study.set questions.0.text \"Who is it?\""});
  expect_typed("study.questions.0.options", "Adult| Child |Neither",
               {"study.set questions.0.options Adult Child Neither"});
  EXPECT_FALSE(shown("study.questions.0.points"));
  choose(app::StudyList::Question, 1);
  expect_typed("study.questions.1.points", "5", {"study.set questions.1.points 5"});
  expect_typed("study.questions.1.low", "Never", {"study.set questions.1.low Never"});
  expect_typed("study.questions.1.every", "4", {"study.set questions.1.every 4"});
  choose(app::StudyList::Question, 2);
  expect_choice("study.questions.2.right", 3, {"study.set questions.2.right Dancing"});
  expect_click("study.add_likert", {"study.add_question likert"});
  expect_click("study.add_choice", {"study.add_question choice"});
  expect_click("study.add_attention", {"study.add_question attention"});
}

TEST_F(StudyPanel, OfLayoutClipsPictureAndPlan) {
  expect_choice("study.layout.panes", 6, {"study.set layout.panes source result"});
  expect_click("study.layout.results.1", {"study.set layout.results pair"});
  expect_click("study.layout.labels", {"study.set layout.labels on"});
  expect_drag("study.clip.seconds", "study.set clip.seconds ");
  expect_typed("study.clip.card", "Again", {"study.set clip.card Again"});
  expect_drag("study.clip.speed", "study.set clip.speed ");
  expect_typed("study.picture.width", "640", {"study.set picture.width 640"});
  expect_typed("study.picture.fps", "60", {"study.set picture.fps 60"});
  expect_click("study.camera", {"study.camera"});
  expect_drag("study.picture.yaw_deg", "study.set picture.yaw_deg ");
  expect_typed("study.plan.participants", "12", {"study.set plan.participants 12"});
  expect_click("study.plan.order.1", {"study.set plan.order latin-square"});
  expect_typed("study.plan.least_right", "75", {"study.set plan.least_right 0.75"});
  expect_click("study.plan.must_exceed", {"study.set plan.must_exceed off"});
}

TEST_F(StudyPanel, OfFilesAndOutputs) {
  expect_click("study.save", {"dialog.open save_study"});
  expect_choice("study.format", 2, {});
  state().study->conditions.back().files.clear();
  app::follow_design(state());
  frame(2);
  EXPECT_FALSE(mark("study.run").enabled);
  EXPECT_FALSE(mark("study.export").enabled) << "not every trial has an animation of \"theirs\"";
  state().study->conditions.pop_back();
  app::follow_design(state());
  state().path = "/a/mine.study";
  frame(2);
  expect_click("study.save", {"study.save"});
  expect_click("study.export", {"dialog.open study_jspsych"});
  expect_click("study.web", {"dialog.open study_web"});
  expect_click("study.run", {"dialog.open study_run"});
  expect_click("study.analyse", {"dialog.open study_answers"});
  expect_click("study.close", {"study.close"});
}

TEST_F(StudyPanel, TrialsAreListedAndChosen) {
  expect_click("study.trial.4", {"study.choose trial 4"});
  expect_typed("study.participant", "P3", {"study.participant P3"});
  state().study->questions.clear();
  app::follow_design(state());
  frame(2);
  EXPECT_FALSE(shown("study.trial.4"));
  EXPECT_TRUE(shown("study.problem"));
  EXPECT_FALSE(shown("study.size"));
}

TEST_F(StudyPanel, ACutNameInTheListOfTrialsIsWholeInItsTooltip) {
  state().study->conditions[0].name =
      "Short arms and legs, of a much longer name than any column has room for";
  app::follow_design(state());
  frame(2);
  hover("study.trial.0", 1.8f);  // of its first cell: in the second
  ASSERT_TRUE(shown("tooltip"));
  EXPECT_GT(mark("tooltip").rect.width(), 300);
}

TEST_F(StudyPanel, ThePictureOfTheChosenTrialIsShownOnceItIsThere) {
  EXPECT_FALSE(shown("study.no_picture")) << "there are no pictures without a window";
  float share = -1;
  TrialPicture picture{nullptr, 0, 0, "Retargeting"};
  context.trial_picture = [&](float at) {
    share = at;
    return picture;
  };
  frame(2);
  EXPECT_TRUE(shown("study.no_picture"));
  EXPECT_FALSE(shown("study.picture"));
  EXPECT_NEAR(static_cast<double>(share), 0.1, 1e-6);
  int some = 0;
  picture = {&some, 640, 360, ""};
  frame(2);
  EXPECT_TRUE(shown("study.picture"));
  const Rect place = mark("study.picture").rect;
  EXPECT_NEAR(static_cast<double>(place.height() / place.width()), 720.0 / 1280, 0.01);
  const ImVec2 at = mark("study.moment").rect.at(0.5f, 0.5f);
  drag(at, {at.x + 60, at.y});
  frame(2);
  EXPECT_GT(share, 0.2f);
}

TEST_F(StudyPanel, SeveralLinesAreWrittenAsOneText) {
  click("study.consent");
  key(render::Key::End, {false, true});
  type("\nThank you.");
  click("study.name");
  const Lines lines = asked();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].substr(0, 17), "study.set consent");
  EXPECT_NE(lines[0].find("Thank you."), std::string::npos) << lines[0];
}

TEST_F(StudyPanel, BeginsWithPresetsAndTheOpenTakes) {
  state() = app::StudyState();
  frame(2);
  expect_click("study.new", {"study.new takes"});
  expect_click("study.new.rekik", {"study.new rekik"});
  expect_click("study.open", {"dialog.open open_study"});
  session.document = app::Document();
  frame(2);
  EXPECT_FALSE(mark("study.new").enabled);
}

/// Every setting of the file has a row in some state of the panel, or a command of its own.
TEST_F(StudyPanel, EverySettingThatIsListedHasARow) {
  std::vector<std::string> missing;
  for (const app::StudyField& field : app::study_fields()) {
    std::string name = field.name;
    for (const auto& [list, chosen] :
         {std::pair("conditions.", "0."), {"motions.", "0."}, {"targets.", "0."}, {"questions.", "0."}})
      if (name.rfind(list, 0) == 0) name.insert(std::string(list).size(), chosen);
    if (!shown("study." + name)) missing.push_back(field.name);
  }
  EXPECT_EQ(missing, (Lines{"conditions.files.path", "conditions.files.motion", "conditions.files.target",
                            "questions.points", "questions.low", "questions.high", "questions.right"}))
      << "those of other kinds alone";
}

}  // namespace
}  // namespace understudy::ui
