// A participant answers a whole study with mouse and keys, before pictures of made clips.
#include "app/studio/study_player.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>

#include "app/run/interrupt.hpp"
#include "app/study/answers.hpp"
#include "app/study/trial_exports.hpp"
#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using render::Key;
using Kind = render::InputEvent::Kind;

const Vec3 kClipColour(0.2f, 0.6f, 0.3f);

/// Clips of 1.2 s, all of one colour.
void write_clips(const Study& study, const std::vector<Trial>& trials, const std::string& folder) {
  fs::create_directories(folder + "/clips");
  std::set<std::string> made;
  for (const Trial& trial : trials) {
    const std::string path = folder + "/" + clip_path(study, trial);
    if (!made.insert(path).second) continue;
    render::VideoWriter writer(path, {320, 180, 10});
    for (int i = 0; i < 12; ++i) writer.push(render::Image(320, 180, kClipColour));
    writer.finish();
  }
}

class StudyPlayerTest : public testing::Test {
 protected:
  StudyPlayerTest() {
    study_.plan.break_every = 9;
    fs::create_directories(folder());
    write_clips(study_, trials_of(study_, "P1"), folder());
  }
  std::string folder() const { return scratch_.path("stimuli"); }
  std::string answers() const { return scratch_.path("answers"); }
  void open() {
    player_.reset();
    run_ = std::make_unique<StudyRun>(study_, "/nowhere", "P1", answers());
    auto surface = std::make_unique<OffscreenSurface>(OffscreenSurface::Options{960, 540, 1, {}});
    surface_ = surface.get();
    player_ = std::make_unique<StudyPlayer>(*run_, folder(), std::move(surface));
    step(6);
  }
  void step(int frames = 1) {
    for (int i = 0; i < frames; ++i) player_->frame(now_s_ += 0.05, 0);
  }
  void key(Key key) {
    render::InputEvent event;
    event.kind = Kind::Key, event.key = key;
    for (const bool pressed : {true, false}) {
      event.pressed = pressed;
      surface_->push(event);
      step();
    }
    step(4);
  }
  void click(const std::string& name) {
    const ui::Mark* mark = player_->gui().find(name);
    ASSERT_NE(mark, nullptr) << name;
    render::InputEvent event;
    const ImVec2 at = mark->rect.at(0.5f, 0.5f);
    event.x = at.x, event.y = at.y;
    surface_->push(event);
    step(2);
    event.kind = Kind::MouseButton;
    for (const bool pressed : {true, false}) {
      event.pressed = pressed;
      surface_->push(event);
      step();
    }
    step(4);
  }
  void watch_clip() {
    for (int guard = 0; run_->screen() == RunScreen::Clip && guard < 100; ++guard) step();
    step(4);
  }
  /// The last answer to each question, by the mouse or by keys.
  void answer(bool by_mouse) {
    watch_clip();
    const std::vector<int> questions = run_->trial().questions;
    for (size_t i = 0; i < questions.size(); ++i) {
      const size_t count = offered_answers(study_.questions[questions[i]]).size();
      if (by_mouse)
        click(printed("run.question.%zu.%zu", i + 1, count));
      else
        key(static_cast<Key>(static_cast<int>(Key::Digit0) + static_cast<int>(count)));
    }
    if (by_mouse)
      click("run.continue");
    else
      key(Key::Enter);
  }
  std::vector<StudyAnswer> saved() const {
    std::vector<std::string> factors;
    return read_participant(answers() + "/P1.csv", factors).answers;
  }
  tests::ScratchFolder scratch_;
  Study study_ = tests::made_study("/nowhere");
  std::unique_ptr<StudyRun> run_;
  std::unique_ptr<StudyPlayer> player_;
  OffscreenSurface* surface_ = nullptr;
  double now_s_ = 0;
};

TEST_F(StudyPlayerTest, ShowsAWholeStudy) {
  open();
  click("run.begin");
  int trials = 0, pauses = 0;
  for (; run_->screen() != RunScreen::End && trials < 100; ++trials) {
    answer(trials % 2 == 0);
    if (run_->screen() != RunScreen::Pause) continue;
    ++pauses;
    key(Key::Enter);
  }
  const std::vector<Trial> shown = trials_of(study_, "P1");
  EXPECT_EQ(trials, static_cast<int>(shown.size()));
  EXPECT_EQ(pauses, 2);  // after practice and after nine trials
  const std::vector<StudyAnswer> all = saved();
  size_t at = 0;
  for (const Trial& trial : shown)
    for (const int q : trial.questions) {
      ASSERT_LT(at, all.size());
      EXPECT_EQ(all[at].trial, trial.id);
      EXPECT_EQ(all[at].question, study_.questions[q].name);
      EXPECT_EQ(all[at].answer, offered_answers(study_.questions[q]).back());
      EXPECT_GT(all[at++].rt_ms, 0);
    }
  EXPECT_EQ(at, all.size());
  click("run.leave");
  EXPECT_TRUE(player_->is_over());
}

TEST_F(StudyPlayerTest, PlaysTheClipInItsOwnTimeAndAgain) {
  open();
  key(Key::Enter);
  ASSERT_EQ(run_->screen(), RunScreen::Clip);
  const double began = now_s_;
  const ui::Mark* clip = player_->gui().find("run.clip");
  ASSERT_NE(clip, nullptr);
  const ImVec2 middle = clip->rect.at(0.5f, 0.5f);
  const render::Image seen = surface_->picture();
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(seen.at(static_cast<int>(middle.x), static_cast<int>(middle.y))[c], 255 * kClipColour[c], 5);
  key(Key::Digit1);  // too early
  watch_clip();
  EXPECT_GT(now_s_ - began, 0.9);
  EXPECT_LT(now_s_ - began, 1.6);
  EXPECT_EQ(run_->chosen()[0], "");
  key(Key::R);
  EXPECT_EQ(run_->screen(), RunScreen::Clip);
  answer(/*by_mouse=*/false);
  EXPECT_EQ(saved()[0].replays, 1);
}

TEST_F(StudyPlayerTest, AsksForEachAnswerAndChangesNone) {
  open();
  key(Key::Enter);
  watch_clip();
  ASSERT_GE(run_->chosen().size(), 2u);
  const auto without_hint = surface_->picture().pixels;
  key(Key::Digit3);
  key(Key::Enter);
  EXPECT_NE(surface_->picture().pixels, without_hint);
  key(Key::Digit1);
  EXPECT_EQ(run_->chosen()[0], "3");
  EXPECT_EQ(run_->chosen()[1], offered_answers(study_.questions[run_->trial().questions[1]])[0]);
}

TEST_F(StudyPlayerTest, OnASlowMachinePassesPicturesOver) {
  open();
  key(Key::Enter);
  for (int i = 0; i < 3; ++i) player_->frame(now_s_ += 0.7, 0);
  step(4);
  EXPECT_EQ(run_->screen(), RunScreen::Questions);
}

TEST_F(StudyPlayerTest, IsLeftAndTakenUpAgain) {
  open();
  key(Key::Enter);
  answer(false);
  key(Key::Escape);
  const size_t before = saved().size();
  step(40);  // the clip stands still
  key(Key::Enter);
  EXPECT_EQ(run_->screen(), RunScreen::Clip);
  key(Key::Escape);
  click("run.stay");
  EXPECT_EQ(run_->screen(), RunScreen::Clip);
  key(Key::Escape);
  click("run.leave");
  EXPECT_TRUE(player_->is_over());
  player_.reset(), run_.reset();
  open();
  EXPECT_TRUE(run_->is_resumed());
  key(Key::Enter);
  answer(true);
  EXPECT_GT(saved().size(), before);
}

/// Last: the request stays.
TEST_F(StudyPlayerTest, EndsWhenItIsAskedTo) {
  catch_interrupts();
  open();
  std::raise(SIGTERM);
  player_->run();
  EXPECT_EQ(run_->screen(), RunScreen::Welcome);
}

}  // namespace
}  // namespace understudy::app
