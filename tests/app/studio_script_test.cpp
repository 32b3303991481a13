// Scripts drive the whole studio as a user would: on the null context, so without a picture.
#include "app/studio/script.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "app/studio/facts.hpp"
#include "app/studio/recorder.hpp"
#include "render/image.hpp"
#include "retarget/base/log.hpp"
#include "tests/app/application_fixture.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

/// Throws in the frames that it is told to.
struct Thrower final : InputListener {
  int left = 0;
  void input(double, const std::vector<render::InputEvent>&, const Session&) override {
    if (left-- > 0) throw Error("this frame went wrong");
  }
  void command(const std::string&, const Arguments&) override {}
};

TEST_F(ApplicationTest, AFrameThatGoesWrongIsToldAndTheStudioGoesOn) {
  make();
  Thrower thrower;
  thrower.left = 3;
  application_->observe(&thrower);
  for (int i = 0; i < 5; ++i) application_->frame(0.02);
  ASSERT_EQ(session().errors.size(), 1u);  // told once
  EXPECT_EQ(session().errors[0].text, "this frame went wrong");
  EXPECT_EQ(application_->drawn(), 2);
  thrower.left = 1000;  // nobody could read that
  EXPECT_THROW(for (int i = 0; i < 100; ++i) application_->frame(0.02), Error);
}

TEST_F(ApplicationTest, ShowsTheStartScreenAtFirst) {
  make();
  play("frames 3\nexpect start.open_source\nexpect menu.file\nexpect_value frames 0");
}

TEST_F(ApplicationTest, OpensPlaysAndSteps) {
  make();
  play(kOpenBoth);
  play(
      "expect_value frames 24\nexpect_value ready_takes 1\nexpect_no start.open_source\n"
      "playback.frame 3\nkey Right\nexpect_value frame 4\nkey Left\nexpect_value frame 3\n"
      "key Space\nexpect_value playing yes\nframes 30\nkey Space\nexpect_value frame >= 5");
}

TEST_F(ApplicationTest, ClicksWidgetsByName) {
  make();
  play(kOpenBoth);
  play(
      "playback.frame 5\nclick timeline.first\nexpect_value frame 0\nclick timeline.forward\n"
      "expect_value frame 1\nclick timeline.play\nexpect_value playing yes\nclick timeline.play\n"
      "expect_value playing no");
}

TEST_F(ApplicationTest, ScrubsByDraggingInTheTrack) {
  make();
  play(kOpenBoth);
  play("playback.frame 0\ndrag timeline.track@0.5,0.8 200 0\nexpect_value frame >= 10");
}

TEST_F(ApplicationTest, UndoesByKey) {
  make();
  play(kOpenBoth);
  play(
      "edit.drag 10 left_wrist 0 0.2 0\nwait\nexpect_value skeleton_edits 1\nexpect_value changed yes\n"
      "key Ctrl+Z\nwait\nexpect_value skeleton_edits 0\nkey Ctrl+Shift+Z\nexpect_value skeleton_edits 1");
}

TEST_F(ApplicationTest, DroppedPathsAreOpened) {
  make();
  play("drop samples/scan.npz samples/target.obj\nwait\nexpect_value frames 24");
}

TEST_F(ApplicationTest, WhatWasClosedIsShownNoMore) {
  make();
  play(kOpenBoth);
  play("frames 5");
  EXPECT_TRUE(application_->shows_take(0));
  play("document.new\nquestion.answer discard\nframes 3\nexpect start.open_source");
  EXPECT_FALSE(application_->shows_take(0));
  play("target.add samples/target.obj\nwait\nframes 5");
  EXPECT_TRUE(application_->shows_take(0));
}

TEST_F(ApplicationTest, FailuresOfTheUserBecomeDialogsThatWait) {
  make();
  play("drop /no/such/file\nframes 3\nexpect_error \"no such file\"\nexpect_value errors 0");
  play("drop /no/such/file\nframes 3");
  EXPECT_THROW(script_->check_no_error(), Error);
}

TEST_F(ApplicationTest, ClosingAsksAboutUnsavedChanges) {
  make();
  play(kOpenBoth);
  play("close\nexpect_value question unsaved");
  EXPECT_FALSE(session().quit);
  play("question.answer cancel\nexpect_value question none\nclose\nquestion.answer discard");
  EXPECT_TRUE(session().quit);
}

TEST_F(ApplicationTest, SavesAndOpensTheSameDocument) {
  make();
  play(kOpenBoth);
  play(
      "edit.drag 10 left_wrist 0 0.2 0\nwait\ndocument.save_as out/dance.understudy\n"
      "expect_value changed no\ndocument.new\nwait\nexpect_value frames 0\n"
      "document.open out/dance.understudy\nwait\nexpect_value frames 24\nexpect_value skeleton_edits 1");
}

TEST_F(ApplicationTest, WritesScreenshotsOfTheSizeAskedFor) {
  make();
  play("screenshot a/start.png 640x400\nscreenshot whole.png");
  EXPECT_EQ(render::read_png(path("out/a/start.png")).width, 640);
  EXPECT_EQ(render::read_png(path("out/whole.png")).height, 800);
}

TEST_F(ApplicationTest, KeepsTheLog) {
  make();
  play("log something was told\nframes 1\nexpect_text \"something was told\"");
}

TEST_F(ApplicationTest, WritesMarksAndFacts) {
  make();
  play(kOpenBoth);
  const std::string marks = tests::read_bytes(path("marks.txt"));
  EXPECT_NE(marks.find("fact frames 24\n"), std::string::npos);
  EXPECT_NE(marks.find("mark timeline.play "), std::string::npos);
}

TEST_F(ApplicationTest, ComplaintsNameScriptLineAndProblem) {
  make();
  EXPECT_EQ(complaint("frames 1\nno.such.command\n"), "test.us:2: there is no command no.such.command");
  EXPECT_NE(complaint("click no.widget").find("test.us:1: nothing on the screen is called no.widget"),
            std::string::npos);
  EXPECT_NE(complaint("# all right\n\nclick").find("test.us:3: click needs"), std::string::npos);
  EXPECT_NE(complaint("frames many").find("many is not a number"), std::string::npos);
  EXPECT_NE(complaint("key Hyper+X").find("is not a key"), std::string::npos);
  EXPECT_NE(complaint("type \"not closed").find("a quote is not closed"), std::string::npos);
  EXPECT_NE(complaint("expect_value frames 7").find("frames is \"0\", not \"7\""), std::string::npos);
  EXPECT_NE(complaint("expect_error \"sky\"").find("no error is shown"), std::string::npos);
  EXPECT_NE(complaint("playback.frame x").find("test.us:1: "), std::string::npos);
  EXPECT_NE(complaint("screenshot a.png 0x0").find("test.us:1: "), std::string::npos);
  EXPECT_NE(complaint("event move one 2").find("one is not a number"), std::string::npos);
}

TEST_F(ApplicationTest, FitsSmallWindowsAndLargeText) {
  for (const float scale : {1.f, 3.f})
    for (const render::PixelSize size : {render::PixelSize{400, 300}, render::PixelSize{1280, 800}}) {
      make(render::ContextKind::Null, size, scale);
      play(kOpenBoth);
      play("frames 5\nclick timeline.play\nexpect_value playing yes\nkey H\nframes 2\nkey Escape");
      EXPECT_EQ(session().errors.size(), 0u);
    }
}

TEST_F(ApplicationTest, ARecordingPlaysAgainToTheSameEnd) {
  const std::string recording = path("record.us");
  std::string frame, edits;
  {
    make();
    Recorder recorder(recording, *application_);
    application_->observe(&recorder);
    recorder.opened("open", {path("scan.npz"), path("target.obj")});
    application_->studio().run("open", {path("scan.npz"), path("target.obj")});
    play(
        "wait\nkey Home\nclick timeline.forward\nclick timeline.forward\ndrag timeline.track@0.2,0.8 300 0\n"
        "key Ctrl+S\nframes 2\nkey Escape");
    frame = fact(session(), "frame");
    application_->observe(nullptr);
  }
  EXPECT_NE(frame, "0");
  make();
  play(tests::read_bytes(recording));
  play("frames 3");
  EXPECT_EQ(fact(session(), "frame"), frame);
}

TEST_F(ApplicationTest, NothingIsRecordedIntoAPipe) {
  make();
  const std::string pipe = path("pipe.us");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDWR);  // so that whoever opens it goes on, and the test fails
  try {
    Recorder(pipe, *application_);
    ADD_FAILURE() << "it was written into";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), pipe + ": is a pipe or a device, not a file");
  }
  ::close(reader);
}

TEST_F(ApplicationTest, GivesTheLogBack) {
  std::vector<std::string> told;
  const auto before = log::set_sink([&told](log::Level, const std::string& text) { told.push_back(text); });
  make();
  log::info("inside");
  application_.reset();
  log::info("outside");
  log::set_sink(before);
  EXPECT_EQ(told, std::vector<std::string>{"outside"});
}

}  // namespace
}  // namespace understudy::app
