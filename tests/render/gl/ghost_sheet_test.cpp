#include "render/ghost_sheet.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"
#include "tests/render/pictures.hpp"

namespace understudy::render {
namespace {

/// A pear that walks.
GhostSeries series(int ghosts, float stride) {
  GhostSeries one;
  one.caption = "a pear";
  for (int i = 0; i < ghosts; ++i) {
    one.ghosts.push_back(make_pear(40, 56, 1.75f));
    one.ghosts.back().vertices.col(2).array() += stride * static_cast<float>(i);
    one.seconds.push_back(0.2 * i);
  }
  return one;
}

GhostSheetOptions narrow() {
  GhostSheetOptions options;
  options.width = 700;
  options.title = "Pears";
  return options;
}

/// Columns of a picture's upper part in which something violet (early) or green to yellow (late) is seen.
struct Seen {
  int early = 0, late = 0;
  double early_at = 0, late_at = 0;  // mean columns
};
Seen seen_in(const Image& image) {
  Seen seen;
  for (int y = 0; y < image.height - 60; ++y)
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = image.at(x, y);
      if (p[2] > p[1] + 25 && p[0] + 10 > p[1]) ++seen.early, seen.early_at += x;
      if (p[1] > p[2] + 40) ++seen.late, seen.late_at += x;
    }
  seen.early_at /= std::max(1, seen.early), seen.late_at /= std::max(1, seen.late);
  return seen;
}

TEST(GhostSheet, ColoursGhostsByTimeFromLeftToRight) {
  const Image sheet = ghost_sheet({series(4, 0.7f)}, narrow());
  const Seen seen = seen_in(sheet);
  EXPECT_GT(seen.early, 500);
  EXPECT_GT(seen.late, 500);
  EXPECT_GT(seen.late_at, seen.early_at + 60);
}

TEST(GhostSheet, HasACellForEachMovementInRows) {
  const Image one = ghost_sheet({series(3, 0.5f)}, narrow());
  const Image four = ghost_sheet(std::vector<GhostSeries>(4, series(3, 0.5f)), narrow());
  const Image five = ghost_sheet(std::vector<GhostSeries>(5, series(3, 0.5f)), narrow());
  EXPECT_EQ(one.width, 700);
  EXPECT_LT(four.height, one.height);
  EXPECT_GT(five.height, four.height);
}

TEST(GhostSheet, AMovementThatIsShorterEndsInAnEarlierColour) {
  GhostSeries quick = series(3, 0.7f);
  for (double& seconds : quick.seconds) seconds *= 0.1;
  EXPECT_EQ(seen_in(ghost_sheet({quick}, narrow())).late > 500, true) << "alone it has the whole scale";
  GhostSheetOptions options = narrow();
  options.columns = 1;
  const Image both = ghost_sheet({series(3, 0.7f), quick}, options);
  Image lower(both.width, both.height / 2);
  std::copy_n(both.at(0, both.height - lower.height), lower.pixels.size(), lower.pixels.begin());
  EXPECT_LT(seen_in(lower).late, 50);
}

TEST(GhostSheet, RefusesWhatItCannotDraw) {
  EXPECT_THROW(ghost_sheet({}, narrow()), Error);
  EXPECT_THROW(ghost_sheet({GhostSeries{}}, narrow()), Error);
  GhostSeries bad = series(2, 1);
  bad.seconds.pop_back();
  EXPECT_THROW(ghost_sheet({bad}, narrow()), Error);
  GhostSheetOptions thin;
  thin.width = 60;
  EXPECT_THROW(ghost_sheet(std::vector<GhostSeries>(4, series(2, 1)), thin), Error);
}

}  // namespace
}  // namespace understudy::render
