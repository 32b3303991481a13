// The study that is open beside the document: its edits, undo, files, and the questions before it is lost.
#include <gtest/gtest.h>
#include <signal.h>

#include "app/session/study_edits.hpp"
#include "app/study/presets.hpp"
#include "app/study/web_study.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

class StudyInStudio : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    StudioServices all = services();
    all.samples = folder_.string();
    all.program = path("runner");
    studio_ = std::make_unique<Studio>(all);
  }
  void run(const std::string& line) {
    Arguments words = split_line(line);
    const std::string name = words.front();
    words.erase(words.begin());
    studio_->run(name, words);
  }
  std::string refusal(const std::string& line) {
    return failure_of([&] { run(line); });
  }
  Session& session() { return studio_->session(); }
  StudyState& state() { return session().study; }
  const Study& study() { return *state().study; }
  /// The dance performed in two ways, as a study that can be run.
  void make_whole() {
    open_both(*studio_);
    run("compare.add 0 engine=paper offsets=off");
    run("study.new takes");
    run("study.add_question likert");
  }

  /// A study that is saved as mine.study, and its clips in `films`.
  void make_shown() {
    make_whole();
    run("study.save_as mine");
    fs::create_directories(path("films/clips"));
    for (const std::string& clip : web_clips(study(), study().plan.participants))
      std::ofstream(path("films/" + clip)) << clip;
  }
  /// What is started in place of the program itself.
  void write_runner(const std::string& script) {
    std::ofstream(path("runner")) << "#!/bin/sh\n" << script;
    fs::permissions(path("runner"), fs::perms::owner_all);
  }
  std::string last_notice() { return session().notices.empty() ? "" : session().notices.back().text; }

  std::unique_ptr<Studio> studio_;
};

TEST_F(StudyInStudio, ComesFromTheOpenTakes) {
  open_both(*studio_);
  run("compare.add 0 engine=paper offsets=off");
  run("playback.in 6");
  run("playback.out 17");
  run("study.new takes");
  ASSERT_EQ(study().conditions.size(), 2u);
  EXPECT_EQ(study().conditions[0].name, "Copy");
  EXPECT_EQ(study().conditions[1].method.engine, "paper");
  EXPECT_NE(study().conditions[1].name.find("no offsets"), std::string::npos) << study().conditions[1].name;
  ASSERT_EQ(study().targets.size(), 1u) << "two takes of one target";
  EXPECT_EQ(study().targets[0].name, "target");
  ASSERT_EQ(study().motions.size(), 1u);
  EXPECT_EQ(study().motions[0].source.path, path("scan.npz"));
  const double fps = session().source.fps;
  EXPECT_NEAR(static_cast<double>(study().motions[0].from_s), 6 / fps, 1e-5);
  ASSERT_TRUE(study().motions[0].seconds);
  EXPECT_NEAR(static_cast<double>(*study().motions[0].seconds), 12 / fps, 1e-5);
  EXPECT_EQ(state().problem, "the study has no question");
  EXPECT_TRUE(state().changed);
  run("study.add_question likert");
  EXPECT_EQ(state().problem, "");
  EXPECT_EQ(state().count, 2);
  EXPECT_EQ(state().trials.size(), 2u);
  run("study.add_conditions");
  run("study.add_target");
  run("study.add_motion");
  EXPECT_EQ(study().conditions.size() + study().targets.size() + study().motions.size(), 4u)
      << "what is there is not added again";
}

TEST_F(StudyInStudio, AnySettingIsChangedByItsName) {
  make_whole();
  run("study.set conditions.1.name \"Paper's network\"");
  run("study.set questions.0.points 5");
  run("study.set plan.order latin-square");
  run("study.set layout.panes source result");
  run("study.set layout.labels on");
  run("study.set picture.background 0 0.5 1");
  run("study.set motions.0.seconds 1.5");
  run("study.set targets.0.target.import.height_m 1.5");
  EXPECT_EQ(study().conditions[1].name, "Paper's network");
  EXPECT_EQ(study().questions[0].points, 5);
  EXPECT_EQ(study().plan.order, TrialOrder::LatinSquare);
  EXPECT_EQ(study().layout.panes, (std::vector<StudyPane>{StudyPane::Source, StudyPane::Result}));
  EXPECT_TRUE(study().layout.labels);
  EXPECT_EQ(study().picture.background, Vec3(0, 0.5f, 1));
  EXPECT_EQ(study().motions[0].seconds, 1.5f);
  EXPECT_EQ(study().targets[0].target.import.height, 1.5f);
  run("study.set motions.0.seconds none");
  run("study.set targets.0.target.import.height_m none");
  EXPECT_FALSE(study().motions[0].seconds);
  EXPECT_FALSE(study().targets[0].target.import.height);
  for (const StudyField& field : study_fields()) EXPECT_EQ(study_field(field.name), &field);
  EXPECT_STREQ(study_field("questions.0.points")->label, "Points");
}

TEST_F(StudyInStudio, WhatASettingCannotBeIsRefusedAndNothingChanges) {
  make_whole();
  const Study before = study();
  EXPECT_EQ(refusal("study.set plan.repetitions 0"),
            "study: plan.repetitions must be a whole number from 1 to 1000");
  EXPECT_EQ(refusal("study.set plan.order backwards"), "study: plan.order must be random or latin-square");
  EXPECT_EQ(refusal("study.set layout.labels maybe"), "study: layout.labels is on or off, not 'maybe'");
  EXPECT_EQ(refusal("study.set clip.seconds long"), "study: clip.seconds is a number, not 'long'");
  EXPECT_EQ(refusal("study.set questions.7.points 5"), "the study has no 'questions.7.points'");
  EXPECT_NE(refusal("study.set plan.luck 5"), "");
  EXPECT_NE(refusal("study.set plan 5"), "");
  EXPECT_EQ(refusal("study.remove motion 3"), "there is no motion 3 in the study");
  EXPECT_TRUE(same(before, study()));
  run("study.close");
  EXPECT_TRUE(session().question);
  run("question.answer discard");
  EXPECT_EQ(refusal("study.set plan.seed 5"), "no study is open");
}

TEST_F(StudyInStudio, EditsOfStudyAndDocumentAreUndoneInTheOrderInWhichTheyWereMade) {
  make_whole();
  run("study.set conditions.0.name Ours");
  run("take.rename 0 me");
  run("study.set plan.repetitions 3");
  EXPECT_EQ(state().count, 6);
  EXPECT_EQ(undo_label(session()), "Change repetitions");
  run("edit.undo");
  EXPECT_EQ(state().count, 2);
  EXPECT_EQ(session().document.takes[0].name, "me");
  run("edit.undo");
  EXPECT_EQ(session().document.takes[0].name, "target");
  EXPECT_EQ(study().conditions[0].name, "Ours");
  run("edit.undo");
  EXPECT_EQ(study().conditions[0].name, "Copy");
  run("edit.redo");
  EXPECT_EQ(study().conditions[0].name, "Ours");
  EXPECT_EQ(session().document.takes[0].name, "target");
  run("edit.redo");
  EXPECT_EQ(session().document.takes[0].name, "me");
  run("edit.redo");
  EXPECT_EQ(state().count, 6);
  EXPECT_EQ(redo_label(session()), "");
  run("edit.undo");
  run("take.rename 0 you");
  EXPECT_EQ(redo_label(session()), "") << "what was undone before another edit cannot be redone";
}

TEST_F(StudyInStudio, FilesOfAConditionFollowTheNamesOfMotionsAndTargets) {
  make_whole();
  run("study.add_files one.glb");
  run("study.add_file 2 two.glb scan target");
  ASSERT_EQ(study().conditions[2].files.size(), 2u);
  EXPECT_EQ(study().conditions[2].files[1].path, path("two.glb"));
  EXPECT_EQ(chosen(state(), StudyList::Condition), 2);
  EXPECT_EQ(state().gone, "condition 'one': " + path("one.glb") + " is gone");
  run("study.set motions.0.name dance");
  run("study.set targets.0.name me");
  EXPECT_EQ(study().conditions[2].files[1].motion, "dance");
  EXPECT_EQ(study().conditions[2].files[1].target, "me");
  run("study.remove_file 2 0");
  ASSERT_EQ(study().conditions[2].files.size(), 1u);
  run("study.remove motion 0");
  EXPECT_TRUE(study().conditions[2].files.empty());
  EXPECT_EQ(state().problem, "the study has no motion");
  EXPECT_TRUE(state().trials.empty());
}

TEST_F(StudyInStudio, ItemsAreCopiedMovedAndRemoved) {
  make_whole();
  run("study.copy condition 0");
  EXPECT_EQ(study().conditions[1].name, "Copy 2");
  EXPECT_EQ(chosen(state(), StudyList::Condition), 1);
  run("study.move condition 1 2");
  EXPECT_EQ(study().conditions[2].name, "Copy 2");
  run("study.remove condition 0");
  EXPECT_EQ(study().conditions.size(), 2u);
  EXPECT_EQ(study().conditions[0].method.engine, "paper");
  EXPECT_EQ(chosen(state(), StudyList::Condition), 1);
}

TEST_F(StudyInStudio, ADraftThatCannotBeRunYetIsSavedAndOpenedAgain) {
  open_both(*studio_);
  run("study.new takes");
  EXPECT_EQ(state().problem, "the study has one condition: it needs two to compare");
  run("study.save_as draft");
  EXPECT_FALSE(state().changed);
  EXPECT_EQ(state().path, path("draft.study"));
  EXPECT_EQ(session().settings.recent_studies.front(), path("draft.study"));
  EXPECT_THROW(read_study(path("draft.study")), Error);
  const Study before = study();
  run("study.close");
  EXPECT_FALSE(state().study);
  run("open draft.study");
  ASSERT_TRUE(state().study);
  EXPECT_TRUE(same(before, study()));
  EXPECT_FALSE(state().changed);
  EXPECT_FALSE(session().question);
  EXPECT_EQ(refusal("study.export csv trials.csv"), state().problem);
}

TEST_F(StudyInStudio, AsksBeforeAnUnsavedStudyIsLost) {
  run("study.new rekik");
  EXPECT_EQ(state().count, 45);
  EXPECT_NE(state().gone, "");  // the samples are not in this folder
  for (const char* line : {"app.quit", "study.new dong", "study.close"}) {
    run(line);
    ASSERT_TRUE(session().question) << line;
    EXPECT_EQ(session().question->kind, Question::Kind::UnsavedStudy);
    EXPECT_EQ(session().question->text, "Save the changes to the study Rekik et al. 2024?");
    EXPECT_FALSE(session().quit);
    EXPECT_NE(refusal("question.answer save"), "") << "it has no file yet";
    run("question.answer cancel");
    EXPECT_EQ(study().name, "Rekik et al. 2024");
  }
  run("study.save_as mine");
  run("study.set plan.seed 8");
  run("app.quit");
  run("question.answer save");
  EXPECT_TRUE(session().quit);
  EXPECT_EQ(read_study(path("mine.study")).plan.seed, 8);
}

TEST_F(StudyInStudio, QuittingAsksForDocumentAndStudyOneAfterTheOther) {
  make_whole();
  run("app.quit");
  EXPECT_EQ(session().question->kind, Question::Kind::UnsavedChanges);
  run("question.answer discard");
  ASSERT_TRUE(session().question);
  EXPECT_EQ(session().question->kind, Question::Kind::UnsavedStudy);
  run("question.answer discard");
  EXPECT_TRUE(session().quit);
}

TEST_F(StudyInStudio, ListsTheTrialsOfAParticipantInTheirOrder) {
  run("study.new rekik");
  const std::vector<Trial> all = state().trials;
  EXPECT_EQ(all.size(), 45u);
  run("study.participant P7");
  ASSERT_EQ(state().trials.size(), 48u);
  EXPECT_TRUE(state().trials.front().is_practice);
  const std::vector<Trial> wanted = trials_of(study(), "P7");
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(state().trials[i].id, wanted[i].id) << i;
  run("study.choose trial 30");
  EXPECT_EQ(chosen(state(), StudyList::Trial), 30);
  run("study.participant");
  EXPECT_EQ(state().trials.size(), 45u);
}

TEST_F(StudyInStudio, ExportsTrialsForEveryRunner) {
  make_whole();
  for (const char* format : {"table", "csv", "jspsych", "psychopy"}) {
    run(std::string("study.export ") + format + " out_" + format);
    studio_->wait_idle();
    ASSERT_TRUE(session().errors.empty()) << session().errors.front().text;
    EXPECT_GT(read_file(path(std::string("out_") + format)).size(), 50u);
  }
  EXPECT_NE(read_file(path("out_csv")).find("target"), std::string::npos);
}

TEST_F(StudyInStudio, AnalysesAFolderOfAnswers) {
  make_whole();
  fs::create_directories(path("answers"));
  const std::string head =
      "participant,trial,question,answer,rt_ms,replays,shown_at,condition,other,motion,target,repetition,"
      "practice\n";
  for (int p = 1; p <= 4; ++p) {
    const std::string name = "P" + std::to_string(p);
    std::ofstream file(path("answers/" + name + ".csv"));
    file << head;
    for (size_t k = 0; k < 2; ++k)
      file << name << ",t00" << k + 1 << ",naturalness," << (k == 0 ? 3 + p % 2 : 5)
           << ",900,0,2026-01-01T00:00:00Z,\"" << study().conditions[k].name << "\",,scan,target,1,0\n";
  }
  run("study.analyse answers/P1.csv");
  studio_->wait_idle();
  ASSERT_TRUE(session().errors.empty()) << session().errors.front().text;
  EXPECT_NE(read_file(path("answers report/index.html")).find("naturalness"), std::string::npos);
  ASSERT_FALSE(session().notices.empty());
  EXPECT_EQ(session().notices.back().text, "Analysed 4 of 4 participants");
  EXPECT_NE(session().notices.back().offer.command.find("index.html"), std::string::npos);
}

TEST_F(StudyInStudio, MakesTheFolderForBrowsers) {
  make_shown();
  EXPECT_EQ(refusal("study.web web"), "the folder of clips is not known: render the stimuli, or name it");
  run("study.web web films");
  studio_->wait_idle();
  ASSERT_TRUE(session().errors.empty()) << session().errors.front().text;
  EXPECT_NE(read_file(path("web/data.js")).find("understudyStudy"), std::string::npos);
  EXPECT_TRUE(fs::exists(path("web/index.html")));
  EXPECT_NE(session().notices.back().offer.command.find("web/index.html"), std::string::npos);
  run("study.web other");
  studio_->wait_idle();
  EXPECT_TRUE(session().errors.empty()) << "the clips used last are known";
  EXPECT_EQ(read_file(path("other/data.js")), read_file(path("web/data.js")));
  run("study.web third nowhere");
  studio_->wait_idle();
  ASSERT_FALSE(session().errors.empty());
  EXPECT_NE(session().errors.front().text.find("study stimuli"), std::string::npos);
}

TEST_F(StudyInStudio, IsSavedBeforeParticipantsSeeIt) {
  make_whole();
  for (const char* line : {"study.web web films", "study.run P01 films answers"})
    EXPECT_EQ(refusal(line), "the study has no file yet: save it under a name");
  run("study.save_as mine");
  run("study.set plan.seed 5");
  for (const char* line : {"study.web web films", "study.run P01 films answers"})
    EXPECT_EQ(refusal(line), "the study is not saved: participants see what is in its file");
  EXPECT_FALSE(studio_->jobs().running());
}

TEST_F(StudyInStudio, RunsAParticipantBesideItself) {
  make_shown();
  fs::create_directories(path("mine answers"));
  std::ofstream(path("mine answers/P01.csv")) << "participant\n";
  write_runner(
      "printf '%s\\n' \"$@\" >words\nwhile [ ! -e go ]; do sleep 0.02; done\n"
      "echo '/a: b/P02.csv: all trials are answered'\n");
  run("study.run \"\" films");
  ASSERT_EQ(session().notices.size(), 1u) << "of saving";
  studio_->tick(0.1);
  EXPECT_TRUE(studio_->jobs().running());
  run("study.set plan.seed 5");  // meanwhile
  std::ofstream(path("go")) << "go";
  studio_->wait_idle();
  ASSERT_TRUE(session().errors.empty()) << session().errors.front().text;
  EXPECT_EQ(last_notice(), "P02: all trials are answered");
  EXPECT_EQ(read_file(path("words")), "study\nrun\n" + path("mine.study") + "\n--participant=P02\n--clips=" +
                                          path("films") + "\n--answers=" + path("mine answers") + "\n");
}

TEST_F(StudyInStudio, SaysWhyARunFailed) {
  make_shown();
  EXPECT_NE(refusal("study.run P01 films").find("runner: cannot be started"), std::string::npos);
  write_runner("echo warning >&2\necho 'understudy: P01 is being written' >&2\nexit 1\n");
  run("study.run P01 films");
  studio_->wait_idle();
  ASSERT_FALSE(session().errors.empty());
  EXPECT_EQ(session().errors.back().text, "P01 is being written");
  write_runner("kill -9 $$\n");
  run("study.run P01 films");
  studio_->wait_idle();
  EXPECT_NE(session().errors.back().text.find("the run of P01 has crashed"), std::string::npos);
}

TEST_F(StudyInStudio, ARunThatIsCancelledEnds) {
  make_shown();
  write_runner("trap '' TERM\necho $$ >id\nwhile true; do sleep 0.02; done\n");
  run("study.run P01 films");
  while (!fs::exists(path("id")) || fs::file_size(path("id")) == 0) studio_->tick(0.01);
  studio_->jobs().cancel(studio_->jobs().views().front().id);
  studio_->wait_idle();
  EXPECT_TRUE(session().errors.empty());
  EXPECT_NE(::kill(std::stoi(read_file(path("id"))), 0), 0);
}

TEST_F(StudyInStudio, TakesTheCameraOfTheView) {
  make_whole();
  run("view.preset left");
  run("view.light turn 40");
  run("study.camera");
  EXPECT_NEAR(static_cast<double>(study().picture.yaw_deg), -90, 0.1);
  EXPECT_NEAR(static_cast<double>(study().picture.pitch_deg), 0, 0.1);
  EXPECT_EQ(study().picture.light_turn_deg, 40);
}

}  // namespace
}  // namespace understudy::app
