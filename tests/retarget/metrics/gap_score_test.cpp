#include "retarget/metrics/gap_score.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

/// All joints at the origin in ten frames; in frames 4 and 5 they are off by 0.5 and 1 m across the floor.
FilledGap two_frames_off(float by) {
  FilledGap gap;
  gap.truth.assign(10, Joints::Zero());
  gap.joints = gap.truth;
  gap.joints[4].rowwise() += Eigen::RowVector3f(0.3f * by, 0, 0.4f * by);
  gap.joints[5].rowwise() += Eigen::RowVector3f(0.6f * by, 0, 0.8f * by);
  gap.first = 4, gap.last = 5;
  gap.doubt.assign(10, 0);
  gap.doubt[4] = 0.1f * by, gap.doubt[5] = 0.2f * by;
  return gap;
}

TEST(GapScore, HasTheFiguresOfTheUnknownFrames) {
  GapScore score;
  FilledGap gap = two_frames_off(1);
  gap.vertex_errors = {0.2, 0.4};
  score.push(gap, 30);
  auto figures = score.figures();
  EXPECT_NEAR(figures.at("gap_mpjpe_m"), 0.75, 1e-6);
  EXPECT_NEAR(figures.at("gap_rel_mpjpe_m"), 0, 1e-6);
  EXPECT_NEAR(figures.at("mve_m"), 0.3, 1e-6);
  EXPECT_NEAR(figures.at("gap_foot_skate"), 30 * (0.5 + 0.5 + 1) / 3, 1e-4);
  EXPECT_EQ(figures.at("gap_foot_skate_true"), 0);
  // second differences of frames 3 to 6: 0.5, 0, -1.5, 1
  EXPECT_NEAR(figures.at("gap_acc"), 0.75, 1e-6);
  EXPECT_NEAR(figures.at("seam_m"), 0.75, 1e-6);
  EXPECT_EQ(figures.count("spread"), 0u);  // of two frames
}

TEST(GapScore, RelativeErrorsAreLessThePelvis) {
  FilledGap gap = two_frames_off(1);
  for (const size_t t : {4, 5}) gap.joints[t].row(Head) += Eigen::RowVector3f(0, 0.22f, 0);
  GapScore score;
  score.push(gap, 30);
  EXPECT_NEAR(score.figures().at("gap_rel_mpjpe_m"), 0.01, 1e-6);
}

TEST(GapScore, KnownFramesNeverCount) {
  FilledGap gap = two_frames_off(1);
  GapScore score, other;
  score.push(gap, 30);
  for (const size_t t : {0, 1, 8, 9}) gap.joints[t].setConstant(7), gap.doubt[t] = 9;
  other.push(gap, 30);
  EXPECT_EQ(score.figures(), other.figures());
}

TEST(GapScore, SeamsAreAtThirtyFramesASecond) {
  GapScore score;
  score.push(two_frames_off(1), 60);
  EXPECT_NEAR(score.figures().at("seam_m"), 4 * 0.75, 1e-5);
}

TEST(GapScore, CountsAllGapsAlikeAndComparesDoubtsOfAll) {
  GapScore score, more;
  score.push(two_frames_off(1), 30);
  more.push(two_frames_off(2), 30);
  more.push(two_frames_off(3), 30);
  score.append(more);
  EXPECT_NEAR(score.figures().at("gap_mpjpe_m"), 0.75 * 2, 1e-5);
  EXPECT_NEAR(score.figures().at("spread"), 1, 1e-9);
  FilledGap sure = two_frames_off(9);
  sure.doubt.assign(10, 0);
  score.push(sure, 30);
  EXPECT_LT(score.figures().at("spread"), 0.2);
}

TEST(GapScore, AGapAtTheStartHasOneSeam) {
  FilledGap gap = two_frames_off(1);
  for (auto* list : {&gap.joints, &gap.truth}) list->erase(list->begin(), list->begin() + 4);
  gap.doubt.erase(gap.doubt.begin(), gap.doubt.begin() + 4);
  gap.first = 0, gap.last = 1;
  GapScore score;
  score.push(gap, 30);
  EXPECT_NEAR(score.figures().at("seam_m"), (1.5 + 1) / 2, 1e-6);
}

TEST(GapScore, WhatIsPredictedHasItsErrorsByTheFrame) {
  FilledGap gap = two_frames_off(0);
  gap.first = 1, gap.last = 9;
  for (int t = 0; t < 9; ++t) gap.vertex_errors.push_back(0.1 * (t + 1));
  GapScore score;
  score.push(gap, 30);
  const auto figures = score.figures();
  EXPECT_NEAR(figures.at("mve_3_m"), 0.3, 1e-9);
  EXPECT_NEAR(figures.at("mve_8_m"), 0.8, 1e-9);
  EXPECT_EQ(figures.count("mve_15_m"), 0u);  // there are nine
  EXPECT_NEAR(figures.at("mve_m"), 0.5, 1e-9);
  gap.last = 8, gap.vertex_errors.pop_back();  // something is known after it
  GapScore between;
  between.push(gap, 30);
  EXPECT_EQ(between.figures().count("mve_3_m"), 0u);
}

TEST(GapScore, HasTheMeanDistanceOfSurfaces) {
  GapScore score, more;
  EXPECT_TRUE(score.empty());
  score.push_surface(0.01);
  more.push_surface(0.02);
  more.push_surface(0.06);
  EXPECT_FALSE(score.empty());
  score.append(more);
  EXPECT_NEAR(score.figures().at("chamfer_m"), 0.03, 1e-9);
}

TEST(GapScore, RefusesWhatDoesNotFit) {
  GapScore score;
  FilledGap gap = two_frames_off(1);
  gap.last = 10;
  EXPECT_THROW(score.push(gap, 30), Error);
  gap = two_frames_off(1);
  gap.doubt.pop_back();
  EXPECT_THROW(score.push(gap, 30), Error);
  gap = two_frames_off(1);
  gap.vertex_errors = {1};
  EXPECT_THROW(score.push(gap, 30), Error);
  EXPECT_TRUE(score.empty());
  EXPECT_TRUE(score.figures().empty());
}

}  // namespace
}  // namespace understudy
