#include "app/cli/preview.hpp"

#include <gtest/gtest.h>

namespace understudy::app {
namespace {

std::vector<int> shown_frames(std::optional<int64_t> count, int frames) {
  PreviewMoments moments(count);
  for (int i = 0; i < frames; ++i) {
    render::SheetMoment moment;
    moment.frame = i;
    if (moments.wanted(i)) moments.add(i, moment);
  }
  std::vector<int> shown;
  for (const auto& moment : moments.take()) shown.push_back(moment.frame);
  return shown;
}

TEST(PreviewMoments, SpreadOverAKnownLength) {
  EXPECT_EQ(shown_frames(91, 91), (std::vector<int>{0, 18, 36, 54, 72, 90}));
}

TEST(PreviewMoments, TakeAllOfAShortSequence) {
  EXPECT_EQ(shown_frames(3, 3), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(shown_frames(std::nullopt, 1), (std::vector<int>{0}));
}

TEST(PreviewMoments, SpreadOverAnUnknownLength) {
  for (const int frames : {7, 12, 13, 40, 1000}) {
    const auto shown = shown_frames(std::nullopt, frames);
    ASSERT_EQ(shown.size(), 6u) << frames;
    EXPECT_EQ(shown.front(), 0);
    EXPECT_GT(shown.back(), frames / 2 - 1) << frames;
  }
}

TEST(PreviewMoments, ShowAsManyAsAreWanted) {
  PreviewMoments moments(60, 60);
  for (int i = 0; i < 60; ++i)
    if (moments.wanted(i)) moments.add(i, {});
  EXPECT_EQ(moments.take().size(), 60u);
}

}  // namespace
}  // namespace understudy::app
