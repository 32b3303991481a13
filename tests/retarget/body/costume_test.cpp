#include "retarget/body/costume.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/standing_person.hpp"

namespace understudy {
namespace {

using fixtures::count_of;
using Standing = fixtures::StandingPerson;

/// Half the width of all at a height, metres.
float width_at(const LabelledPoints& cloud, float height) {
  float width = 0;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i)
    if (std::abs(cloud.points(i, 1) - height) < 0.02f) width = std::max(width, std::abs(cloud.points(i, 2)));
  return width;
}

TEST(Costume, SkirtHidesTheLegsAndIsWiderThanThey) {
  const Standing person;
  int wide = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    LabelledPoints dressed = person.cloud;
    Rng rng(seed);
    wear_skirt(dressed, person.truth, rng);
    ASSERT_EQ(dressed.parts.size(), static_cast<size_t>(dressed.points.rows()));
    EXPECT_EQ(count_of(dressed, Head), count_of(person.cloud, Head));
    EXPECT_EQ(count_of(dressed, LeftElbow), count_of(person.cloud, LeftElbow));
    const float thigh = person.truth.joints(LeftHip, 1) - 0.3f * person.leg();
    EXPECT_GE(width_at(dressed, thigh), width_at(person.cloud, thigh));
    if (width_at(dressed, thigh) > 1.3f * width_at(person.cloud, thigh)) ++wide;
    // Between the thighs there is nothing any more.
    for (Eigen::Index i = 0; i < dressed.points.rows(); ++i)
      if (std::abs(dressed.points(i, 1) - thigh) < 0.02f)
        EXPECT_GT(dressed.points.row(i).leftCols(1).norm() + std::abs(dressed.points(i, 2)), 0.05f);
  }
  EXPECT_GE(wide, 3);
}

TEST(Costume, CoatThickensTheTrunkAndLeavesTheRest) {
  const Standing person;
  LabelledPoints dressed = person.cloud;
  Rng rng(4);
  wear_coat(dressed, person.truth, rng);
  const Eigen::VectorXf moved = (dressed.points - person.cloud.points).rowwise().norm();
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    const int part = person.cloud.parts[i];
    if (part == LeftKnee || part == Head || part == Pelvis) EXPECT_EQ(moved[i], 0);
    if (part == Spine2) EXPECT_GT(moved[i], 0.009f);
    EXPECT_LT(moved[i], 0.061f);
  }
}

TEST(Costume, HairIsAboutTheHead) {
  const Standing person;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    LabelledPoints dressed = person.cloud;
    Rng rng(seed);
    wear_hair(dressed, person.truth, rng);
    ASSERT_NE(dressed.points.rows(), person.cloud.points.rows());
    for (Eigen::Index i = 0; i < dressed.points.rows(); ++i)
      if (dressed.parts[i] == Head)
        EXPECT_LT((dressed.points.row(i) - person.truth.joints.row(Head)).norm(), 0.4f);
  }
}

TEST(Costume, ThingsAreHeldInAHandAndAreNotTheBody) {
  const Standing person;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    LabelledPoints holding = person.cloud;
    Rng rng(seed);
    hold_thing(holding, person.truth, rng);
    float nearest = 10;
    for (Eigen::Index i = person.cloud.points.rows(); i < holding.points.rows(); ++i) {
      EXPECT_EQ(holding.parts[i], kNoBody);
      for (const int wrist : {LeftWrist, RightWrist})
        nearest = std::min(nearest, (holding.points.row(i) - person.truth.joints.row(wrist)).norm());
    }
    EXPECT_LT(nearest, 0.15f);
  }
}

TEST(PartialView, OneSideIsWhatOneCameraSees) {
  const Standing person;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    LabelledPoints seen = person.cloud;
    Rng rng(seed);
    see_from_one_side(seen, person.truth, rng);
    EXPECT_GT(seen.points.rows(), person.cloud.points.rows() / 5);
    EXPECT_LT(seen.points.rows(), 4 * person.cloud.points.rows() / 5);
    // The trunk's front or back or side: what is left of it leans to one way.
    Vec3 mean = Vec3::Zero();
    for (Eigen::Index i = 0; i < seen.points.rows(); ++i)
      if (seen.parts[i] == Spine2) mean += seen.points.row(i);
    mean /= static_cast<float>(count_of(seen, Spine2));
    EXPECT_GT(Vec3(mean.x(), 0, mean.z() - person.truth.joints(Spine2, 2)).norm(), 0.02f);
  }
}

TEST(PartialView, LostLimbsAreGoneWithAllThatFollows) {
  const Standing person;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    LabelledPoints seen = person.cloud;
    Rng rng(seed);
    lose_limb(seen, rng);
    EXPECT_LT(seen.points.rows(), person.cloud.points.rows());
    EXPECT_EQ(count_of(seen, Spine2), count_of(person.cloud, Spine2));
    for (size_t j = 1; j < kJointCount; ++j)
      if (kParents[j] > 0 && count_of(person.cloud, kParents[j]) > 0 && count_of(seen, kParents[j]) == 0)
        EXPECT_EQ(count_of(seen, static_cast<int>(j)), 0) << kJointNames[j];
  }
}

}  // namespace
}  // namespace understudy
