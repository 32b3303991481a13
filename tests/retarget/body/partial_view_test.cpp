#include "retarget/body/partial_view.hpp"

#include <gtest/gtest.h>

#include "retarget/body/block.hpp"
#include "retarget/body/cell_image.hpp"
#include "tests/support/standing_person.hpp"

namespace understudy {
namespace {

using fixtures::count_of;
using fixtures::StandingPerson;

constexpr uint64_t kSeeds = 20;

using Hides = void (*)(LabelledPoints&, const PosedSkeleton&, Rng&);

LabelledPoints left_by(Hides hide, const StandingPerson& person, uint64_t seed) {
  LabelledPoints cloud = person.cloud;
  Rng rng(seed);
  hide(cloud, person.truth, rng);
  return cloud;
}

TEST(CutBelow, LeavesTheHeadAndMostOftenNoFeet) {
  const StandingPerson person;
  int footless = 0, legless = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const LabelledPoints left = left_by(cut_below, person, seed);
    ASSERT_EQ(left.parts.size(), static_cast<size_t>(left.points.rows()));
    EXPECT_EQ(count_of(left, Head), count_of(person.cloud, Head));
    footless += count_of(left, LeftFoot) + count_of(left, RightFoot) == 0;
    legless += count_of(left, LeftKnee) + count_of(left, RightKnee) == 0;
  }
  EXPECT_GE(footless, 14);
  EXPECT_GE(legless, 8);
}

TEST(CutBelow, AtANamedPlaceTakesWhatIsBelow) {
  const StandingPerson person;
  const auto left_at = [&](BodyCut cut, uint64_t seed) {
    LabelledPoints cloud = person.cloud;
    Rng rng(seed);
    cut_below(cloud, person.truth, cut, rng);
    return cloud;
  };
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Eigen::Index before = 0;
    for (const BodyCut cut : {BodyCut::Chest, BodyCut::Hips, BodyCut::Knees, BodyCut::Shins}) {
      const Eigen::Index rows = left_at(cut, seed).points.rows();
      EXPECT_GT(rows, before);
      before = rows;
    }
    EXPECT_EQ(count_of(left_at(BodyCut::Hips, seed), LeftAnkle), 0);
    EXPECT_GT(count_of(left_at(BodyCut::Knees, seed), Pelvis), 0);
  }
}

TEST(CutBelow, StaysWhereItIsWhenThePersonMoves) {
  const StandingPerson person;
  StandingPerson risen = person;  // after the first frame
  risen.cloud.points.col(1).array() += 0.15f;
  StandingPerson higher = risen;  // from the first frame on
  higher.truth.joints.col(1).array() += 0.15f;
  int64_t more = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Eigen::Index rows = left_by(cut_below, person, seed).points.rows();
    EXPECT_NEAR(static_cast<double>(left_by(cut_below, higher, seed).points.rows()),
                static_cast<double>(rows), 3);
    more += left_by(cut_below, risen, seed).points.rows() - rows;
  }
  EXPECT_GT(more, 40 * static_cast<int64_t>(kSeeds));
}

TEST(CutBeside, TakesOneArmAndLeavesTheOther) {
  const StandingPerson person;
  int one = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const LabelledPoints left = left_by(cut_beside, person, seed);
    const bool no_left = count_of(left, LeftWrist) == 0, no_right = count_of(left, RightWrist) == 0;
    EXPECT_FALSE(no_left && no_right);
    if (no_left) EXPECT_EQ(count_of(left, RightElbow), count_of(person.cloud, RightElbow));
    one += no_left || no_right;
  }
  EXPECT_GE(one, 15);
}

TEST(Desk, HidesFeetMostOftenAndNeverTheHead) {
  const StandingPerson person;
  int footless = 0, with_desk = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const LabelledPoints left = left_by(put_behind_desk, person, seed);
    EXPECT_GT(count_of(left, Head), count_of(person.cloud, Head) / 5);
    footless += count_of(left, LeftFoot) + count_of(left, RightFoot) == 0;
    with_desk += count_of(left, kNoBody) > 0;
  }
  EXPECT_GE(footless, 8);
  EXPECT_GE(with_desk, 4);
  EXPECT_LE(with_desk, 16);
}

TEST(PartialView, IsTheSameForTheSameRandomNumbers) {
  const StandingPerson person;
  for (const Hides hide : {cut_below, cut_beside, put_behind_desk})
    EXPECT_EQ(left_by(hide, person, 3).points, left_by(hide, person, 3).points);
}

TEST(Block, BlocksWhatIsBehindIt) {
  Block block;
  block.half = Vec3(1, 0.5f, 0.1f);
  EXPECT_TRUE(block.blocks(Vec3(0, 0, 2), Vec3(0, 0, -2)));
  EXPECT_TRUE(block.blocks(Vec3(0, 0, 2), Vec3(0, 0, 0)));
  EXPECT_FALSE(block.blocks(Vec3(0, 0, 2), Vec3(0, 0, 0.2f)));
  EXPECT_FALSE(block.blocks(Vec3(0, 0.6f, 2), Vec3(0, 0.6f, -2)));
  EXPECT_TRUE(block.blocks(Vec3(0, 1, 2), Vec3(0, -1, -2)));
}

TEST(Block, SamplesLieOnItsSurface) {
  Rng rng(1);
  Block block;
  block.half = Vec3(0.4f, 0.2f, 0.1f);
  block.centre = Vec3(1, 2, 3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 share = block.own(block.sample(rng)).cwiseAbs().cwiseQuotient(block.half);
    EXPECT_NEAR(share.maxCoeff(), 1, 1e-4f);
  }
}

TEST(CellImage, ShowsWhatNothingHidesAndFindsEdges) {
  Points image(3, 3);
  image << 0.5f, 0.5f, 1, 0.6f, 0.5f, 0, 5.5f, 0.5f, 0;
  const CellImage cells(image);
  EXPECT_TRUE(cells.shows(0, 0.1f));
  EXPECT_FALSE(cells.shows(1, 0.1f));
  EXPECT_TRUE(cells.shows(2, 0.1f));
  EXPECT_TRUE(cells.is_at_edge(2, 0.1f));
  Points full(25, 3);
  for (int i = 0; i < 25; ++i) full.row(i) << static_cast<float>(i % 5), static_cast<float>(i / 5), 0;
  const CellImage wall(full);
  EXPECT_FALSE(wall.is_at_edge(12, 0.1f));
  EXPECT_TRUE(wall.is_at_edge(0, 0.1f));
}

}  // namespace
}  // namespace understudy
