#include "app/session/shared_frames.hpp"

#include <gtest/gtest.h>

#include "app/session/refiner.hpp"

namespace understudy::app {
namespace {

/// Counts how often a frame was copied.
struct CountedFrame {
  static int copies;
  int value = 0;
  explicit CountedFrame(int v = 0) : value(v) {}
  CountedFrame(const CountedFrame& other) : value(other.value) { ++copies; }
  CountedFrame(CountedFrame&&) = default;
  CountedFrame& operator=(const CountedFrame& other) {
    value = other.value;
    ++copies;
    return *this;
  }
  CountedFrame& operator=(CountedFrame&&) = default;
};
int CountedFrame::copies = 0;

using Frames = SharedFrames<CountedFrame>;

Frames counted(int count) {
  Frames frames;
  frames.write(0, count, [](size_t i, CountedFrame& frame) { frame.value = static_cast<int>(i); });
  return frames;
}

TEST(SharedFrames, AreReadAsTheyWereWritten) {
  Frames frames = counted(200);
  frames.push_back(CountedFrame(200));
  frames.write(100, 300, [](size_t i, CountedFrame& frame) { frame.value += 1000 + static_cast<int>(i); });
  ASSERT_EQ(frames.size(), 300u);
  int i = 0;
  for (const CountedFrame& frame : frames) {
    EXPECT_EQ(frame.value, i < 100 ? i : 1000 + i + (i <= 200 ? i : 0)) << i;
    ++i;
  }
  EXPECT_EQ(i, 300);
  frames.write(350, 351, [](size_t, CountedFrame& frame) { frame.value = 7; });
  EXPECT_EQ(frames[349].value, 0);
  EXPECT_EQ(frames[350].value, 7);
  frames.clear();
  EXPECT_TRUE(frames.empty());
}

TEST(SharedFrames, ACopyCopiesNoFrame) {
  const Frames frames = counted(1000);
  CountedFrame::copies = 0;
  const Frames copy = frames;
  EXPECT_EQ(CountedFrame::copies, 0);
  for (size_t i = 0; i < 1000; ++i) EXPECT_EQ(&copy[i], &frames[i]) << i;
}

TEST(SharedFrames, AWriteCopiesOneChunkAndLeavesTheCopiesAlone) {
  Frames frames = counted(1000);
  const Frames copy = frames;
  CountedFrame::copies = 0;
  frames.write(500, 501, [](size_t, CountedFrame& frame) { frame.value = -1; });
  EXPECT_LE(CountedFrame::copies, static_cast<int>(Frames::kChunk));
  EXPECT_EQ(frames[500].value, -1);
  EXPECT_EQ(copy[500].value, 500);
  EXPECT_EQ(&copy[300], &frames[300]);
  EXPECT_EQ(&copy[700], &frames[700]);
}

TEST(SharedFrames, ARequestToRefineHasTheSessionsFrames) {
  Session session;
  session.takes.resize(1);
  session.takes[0].performed.write(0, 300, [](size_t, KeptFrame&) {});
  session.source.frames.write(0, 300, [](size_t, KeptSource&) {});
  const RefineRequest request{1, session.takes[0].performed, 30, {}, nullptr, session.source.frames, nullptr};
  for (size_t t = 0; t < 300; ++t) {
    EXPECT_EQ(&request.performed[t], &session.takes[0].performed[t]);
    EXPECT_EQ(&request.source[t], &session.source.frames[t]);
  }
}

}  // namespace
}  // namespace understudy::app
