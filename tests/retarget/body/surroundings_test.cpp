#include "retarget/body/surroundings.hpp"

#include <gtest/gtest.h>

#include "retarget/math/segment.hpp"
#include "tests/support/standing_person.hpp"

namespace understudy {
namespace {

using fixtures::StandingPerson;

using Adds = void (*)(LabelledPoints&, const PosedSkeleton&, SceneRandom);

/// The points that a thing adds; checks that they are no body and that the body stays.
Points added_by(Adds add, const StandingPerson& person, uint64_t scene, Rng& rng) {
  LabelledPoints cloud = person.cloud;
  add(cloud, person.truth, {Rng(scene), rng});
  const Eigen::Index own = person.cloud.points.rows(), more = cloud.points.rows() - own;
  EXPECT_EQ(cloud.parts.size(), static_cast<size_t>(cloud.points.rows()));
  EXPECT_EQ(cloud.points.topRows(own), person.cloud.points);
  for (Eigen::Index i = own; i < cloud.points.rows(); ++i) EXPECT_EQ(cloud.parts[i], kNoBody);
  EXPECT_LT(more, 0.45f * own);
  return cloud.points.bottomRows(more);
}

float from_bones(const Vec3& x, const StandingPerson& person) {
  float nearest = 10;
  for (int j = 1; j < kJointCount; ++j)
    nearest = std::min(nearest, from_segment(x, person.joint(kParents[j]), person.joint(j)).norm());
  return nearest;
}

TEST(Surroundings, AreNoBodyStayWhereTheyAreAndHaveNewPointsInEachFrame) {
  const StandingPerson person;
  Rng rng(1);
  for (const Adds add :
       {Adds(add_ground), Adds(add_furniture), Adds(add_chair_below), Adds(add_loose_ball)}) {
    int some = 0;
    for (uint64_t scene = 1; scene <= 12; ++scene) {
      const Points now = added_by(add, person, scene, rng), later = added_by(add, person, scene, rng);
      if (now.rows() < 500 || later.rows() < 500) continue;
      ++some;
      EXPECT_NE(now.topRows(1), later.topRows(1));
      EXPECT_LT((now.colwise().mean() - later.colwise().mean()).norm(), 0.12f);
    }
    EXPECT_GE(some, 4);
  }
}

TEST(Surroundings, ThingsAreNotInThePerson) {
  const StandingPerson person;
  Rng rng(2);
  for (const Adds add : {Adds(add_furniture), Adds(add_chair_below), Adds(add_loose_ball)})
    for (uint64_t scene = 1; scene <= 8; ++scene) {
      const Points more = added_by(add, person, scene, rng);
      for (Eigen::Index i = 0; i < more.rows(); ++i) ASSERT_GT(from_bones(more.row(i), person), 0.08f);
    }
}

TEST(Surroundings, TheGroundIsBelowTheFeet) {
  const StandingPerson person;
  Rng rng(3);
  const float sole = person.cloud.points.col(1).minCoeff();
  for (uint64_t scene = 1; scene <= 12; ++scene) {
    const Points ground = added_by(add_ground, person, scene, rng);
    ASSERT_GT(ground.rows(), 50);
    EXPECT_NEAR(ground.col(1).mean(), sole, 0.15f);
  }
}

TEST(Surroundings, APieceOfSomebodyBesideIsSmallAndNear) {
  const StandingPerson person, other;
  Rng rng(4);
  int some = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    Rng scene(seed);
    const Vec3 shift = shift_beside(person.truth, other.truth, scene);
    EXPECT_NEAR(shift.y(), 0, 1e-5f);
    EXPECT_GT(shift.norm(), 0.3f);
    EXPECT_LT(shift.norm(), 1.6f);
    LabelledPoints moved = other.cloud, cloud = person.cloud;
    PosedSkeleton others = other.truth;
    moved.points.rowwise() += shift.transpose();
    others.joints.rowwise() += shift.transpose();
    add_piece(cloud, person.truth, moved, others, {Rng(seed), rng});
    const Eigen::Index more = cloud.points.rows() - person.cloud.points.rows();
    EXPECT_LE(more, 0.31f * person.cloud.points.rows());
    for (Eigen::Index i = person.cloud.points.rows(); i < cloud.points.rows(); ++i)
      ASSERT_EQ(cloud.parts[i], kNoBody);
    some += more > 20;
  }
  EXPECT_GE(some, 6);
}

}  // namespace
}  // namespace understudy
