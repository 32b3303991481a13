// The bad frames panel: runs of frames with the same reason, and the way to them.
#include "tests/ui/support/panels_test.hpp"

namespace understudy::ui {
namespace {

class BadFrames : public PanelsTest {
 protected:
  BadFrames() {
    input.size = {500, 300};
    for (const int i : {40, 41, 42}) flag_frame(i, "too few points");
    panel("bad_frames");
  }
};

TEST_F(BadFrames, AClickShowsTheFirstFrameOfItsRun) {  // bad: 20, 31, and the run 40 to 42
  EXPECT_FALSE(shown("bad_frames.list.3"));
  expect_click("bad_frames.list.0", {"playback.frame 20"});
  expect_click("bad_frames.list.1", {"playback.frame 31"});
  expect_click("bad_frames.list.2", {"playback.frame 40"});
}

TEST_F(BadFrames, AreSearchedByTheirReason) {
  write_into("bad_frames.list.search", "few points");
  frame(2);
  EXPECT_FALSE(shown("bad_frames.list.0"));
  EXPECT_TRUE(shown("bad_frames.list.2"));
}

TEST_F(BadFrames, WithoutAnyThereIsNoList) {
  session.source.frames.clear(), ++session.source.generation;
  frame(2);
  EXPECT_FALSE(shown("bad_frames.list.search"));
  expect_click("bad_frames.close", {"panel.show bad_frames off"});
}

}  // namespace
}  // namespace understudy::ui
