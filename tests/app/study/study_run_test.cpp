// One participant's way through a study, and the file that holds their answers.
#include "app/study/study_run.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "app/study/study_analysis.hpp"
#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

class StudyRunTest : public testing::Test {
 protected:
  StudyRunTest() { study_.plan.break_every = 5; }
  StudyRun start(const std::string& name = "P1") const { return {study_, "/nowhere", name, folder()}; }
  std::string complaint(const std::string& name = "P1") const {
    return failure_of([&] { start(name); });
  }
  std::string folder() const { return scratch_.path("answers"); }
  std::string file() const { return folder() + "/P1.csv"; }
  /// Answers the trial that is shown: the first of what each question offers, so many seconds after the clip.
  static void answer(StudyRun& run, double after_s = 1) {
    run.clip_ended(100, "2026-01-01T00:00:00Z");
    for (size_t i = 0; i < run.chosen().size(); ++i) {
      const StudyQuestion& question = run.study().questions[run.trial().questions[i]];
      run.choose(static_cast<int>(i), offered_answers(question)[0],
                 100 + after_s * static_cast<double>(i + 1));
    }
    run.confirm();
  }
  /// So many trials, practice among them.
  static void answer_all(StudyRun& run, int trials = 1000) {
    for (int done = 0; done < trials && run.screen() != RunScreen::End; ++done) {
      run.begin();
      answer(run);
    }
  }
  std::vector<StudyAnswer> saved() const {
    std::vector<std::string> factors;
    return read_participant(file(), factors).answers;
  }
  Study study_ = tests::made_study("/nowhere");
  tests::ScratchFolder scratch_;
};

TEST_F(StudyRunTest, GoesFromWelcomeToEnd) {
  StudyRun run = start();
  EXPECT_EQ(run.screen(), RunScreen::Welcome);
  EXPECT_FALSE(run.is_resumed());
  std::string way;
  for (int guard = 0; run.screen() != RunScreen::End && guard < 200; ++guard) {
    if (run.screen() == RunScreen::Pause) way += "|";
    run.begin();
    way += run.trial().is_practice ? "p" : "t";
    answer(run);
  }
  EXPECT_EQ(way, "pp|ttttt|ttttt|ttttt|ttt");  // 3 conditions, 2 motions, 3 targets
  const std::vector<Trial> trials = trials_of(study_, "P1");
  size_t asked = 0;
  for (const Trial& trial : trials) asked += trial.questions.size();
  EXPECT_EQ(saved().size(), asked);
}

TEST_F(StudyRunTest, SavesWhatAnalysisReads) {
  StudyRun run = start();
  answer_all(run);
  const StudyAnswers answers = counted_answers(read_answers(folder()), study_, "/nowhere");
  const std::vector<Trial> trials = trials_of(study_, "P1");
  EXPECT_EQ(answers.factors,
            (std::vector<std::string>{"condition", "other", "motion", "target", "repetition", "practice"}));
  const StudyAnswer& first = answers.participants[0].answers[0];
  const Trial& trial = trials[2];  // after two of practice
  EXPECT_EQ(first.trial, trial.id);
  EXPECT_EQ(first.answer, "1");
  EXPECT_EQ(first.rt_ms, 1000);
  EXPECT_EQ(first.shown_at, "2026-01-01T00:00:00Z");
  EXPECT_EQ(first.levels[0], study_.conditions[trial.condition].name);
  EXPECT_EQ(first.levels[3], study_.targets[trial.target].name);
  EXPECT_EQ(first.levels[5], "0");
}

TEST_F(StudyRunTest, WaitsForEachAnswer) {
  StudyRun run = start();
  run.begin();
  run.choose(0, "1", 99);  // the clip still plays
  EXPECT_EQ(run.chosen()[0], "");
  run.clip_ended(100, "now");
  EXPECT_FALSE(run.is_complete());
  run.choose(0, "7", 101);
  run.confirm();
  EXPECT_EQ(run.screen(), RunScreen::Questions);
  EXPECT_EQ(saved()[0].answer, "7");  // at once
  EXPECT_EQ(saved()[1].answer, "");
  EXPECT_EQ(failure_of([&] { run.choose(0, "8", 101); }), "\"8\" is no answer to \"natural\"");
  EXPECT_THROW(run.choose(3, "1", 101), Error);
}

TEST_F(StudyRunTest, CountsReplaysAndTheTimeToTheLastChoice) {
  StudyRun run = start();
  run.begin();
  run.clip_ended(100, "first");
  run.choose(0, "3", 102);
  run.replay();
  EXPECT_EQ(run.screen(), RunScreen::Clip);
  run.clip_ended(110, "second");
  EXPECT_EQ(run.chosen()[0], "3");
  run.choose(0, "4", 112.5);
  for (size_t i = 1; i < run.chosen().size(); ++i)
    run.choose(static_cast<int>(i), offered_answers(study_.questions[run.trial().questions[i]])[1], 113);
  run.confirm();
  EXPECT_EQ(saved()[0].answer, "4");
  EXPECT_EQ(saved()[0].replays, 1);
  EXPECT_EQ(saved()[0].rt_ms, 12500);
  EXPECT_EQ(saved()[0].shown_at, "first");
}

TEST_F(StudyRunTest, GoesOnAfterACrash) {
  const pid_t child = fork();
  if (child == 0) {
    StudyRun run = start();
    answer_all(run, 7);
    run.begin();
    run.clip_ended(100, "before");
    run.replay();
    run.clip_ended(110, "again");
    run.choose(0, "5", 111);
    _exit(0);  // nothing is closed
  }
  int status = 1;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  EXPECT_TRUE(fs::exists(folder() + "/.P1.lock"));
  const size_t before = saved().size();
  {
    StudyRun run = start();
    EXPECT_TRUE(run.is_resumed());
    EXPECT_EQ(run.screen(), RunScreen::Welcome);
    EXPECT_EQ(run.trial().id, trials_of(study_, "P1")[7].id);
    EXPECT_EQ(run.number(), 6);  // two were practice
    run.begin();
    EXPECT_EQ(run.screen(), RunScreen::Clip);
    EXPECT_EQ(run.chosen()[0], "5");
    EXPECT_EQ(run.chosen()[1], "");
    run.clip_ended(50, "after");
    run.choose(1, offered_answers(study_.questions[run.trial().questions[1]])[0], 52);
    const std::vector<StudyAnswer> all = saved();
    const auto first = std::find_if(all.begin(), all.end(),
                                    [&](const StudyAnswer& one) { return one.trial == run.trial().id; });
    ASSERT_GE(all.end() - first, 2);
    const StudyAnswer &kept = *first, &added = *(first + 1);
    EXPECT_EQ(kept.answer, "5");
    EXPECT_EQ(kept.rt_ms, 11000);
    EXPECT_EQ(added.rt_ms, 2000);
    EXPECT_EQ(added.replays, 2);  // one by hand, one after the crash
    EXPECT_EQ(added.shown_at, "before");
    answer_all(run);
  }
  EXPECT_GT(saved().size(), before);
  EXPECT_FALSE(fs::exists(folder() + "/.P1.lock"));
}

TEST_F(StudyRunTest, ThatIsOverStaysSo) {
  {
    StudyRun run = start();
    answer_all(run);
  }
  EXPECT_EQ(start().screen(), RunScreen::End);
}

TEST_F(StudyRunTest, KeepsAnswersThatCannotBeSaved) {
  StudyRun run = start();
  answer_all(run, 3);
  const std::string before = tests::read_bytes(file());
  run.begin();
  {
    const test::FullDisk disk(100);
    run.clip_ended(100, "now");
    for (size_t i = 0; i < run.chosen().size(); ++i) {
      const std::string first = offered_answers(study_.questions[run.trial().questions[i]])[0];
      EXPECT_NE(failure_of([&] { run.choose(static_cast<int>(i), first, 101); }).find(file()),
                std::string::npos);
    }
    EXPECT_NE(failure_of([&] { run.confirm(); }).find(file()), std::string::npos);
  }
  EXPECT_EQ(run.screen(), RunScreen::Questions);
  EXPECT_TRUE(run.is_complete());
  EXPECT_EQ(tests::read_bytes(file()), before);
  run.confirm();
  EXPECT_EQ(run.screen(), RunScreen::Clip);
  EXPECT_GT(tests::read_bytes(file()).size(), before.size());
}

TEST_F(StudyRunTest, OfOneParticipantIsInOneWindow) {
  {
    const StudyRun run = start();
    EXPECT_NE(complaint().find("participant P1 is answering in another window ("), std::string::npos);
    EXPECT_EQ(complaint("P2"), "");
  }
  EXPECT_EQ(complaint(), "");
}

TEST_F(StudyRunTest, RefusesAStudyThatHasChanged) {
  {
    StudyRun run = start();
    answer_all(run, 4);
  }
  study_.plan.participants = 99;  // may change
  EXPECT_EQ(complaint(), "");
  study_.questions[0].text = "How natural was it?";
  EXPECT_EQ(complaint(),
            file() + ": these answers are not to this study; it has changed since: question 'natural'");
  EXPECT_EQ(failure_of([&] { counted_answers(read_answers(folder()), study_, "/nowhere"); }), complaint());
}

TEST_F(StudyRunTest, RefusesFilesAndNamesThatAreNotItsOwn) {
  for (const std::string name : {"", "a/b", ".hidden", "line\nbreak"}) EXPECT_NE(complaint(name), "") << name;
  fs::create_directories(folder());
  std::ofstream(file())
      << "participant,trial,question,answer,rt_ms,replays,shown_at,condition\nP1,t1,q,1,,,,a\n";
  EXPECT_EQ(complaint(), file() + ": was not written here: it has other columns");
  std::ofstream(file()) << "participant,trial,question,answer,rt_ms,replays,shown_at,condition\nP1,t1,q";
  EXPECT_EQ(complaint(), file() + ": is cut off in line 2, which has no line end");
}

}  // namespace
}  // namespace understudy::app
