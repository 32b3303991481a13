#include "retarget/body/depth_cameras.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "retarget/geometry/mesh.hpp"
#include "tests/support/standing_person.hpp"

namespace understudy {
namespace {

using fixtures::count_of;
using fixtures::StandingPerson;

/// A wall of 60 cm in the plane z = 0, and a skeleton that does not matter.
LabelledPoints wall() {
  LabelledPoints cloud;
  Rng rng(2);
  cloud.points.resize(6000, 3);
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i)
    cloud.points.row(i) << rng.uniform(-0.3f, 0.3f), rng.uniform(-0.3f, 0.3f), 0;
  cloud.parts.assign(6000, Spine2);
  return cloud;
}

DepthCamera facing(float distance) {
  DepthCamera camera;
  camera.eye = Vec3(0, 0, distance);
  camera.at = Vec3::Zero();
  camera.floor_noise = 0;
  return camera;
}

LabelledPoints seen(LabelledPoints cloud, const DepthRig& rig) {
  const StandingPerson person;
  Rng rng(4);
  see_with_depth_cameras(cloud, rig, person.truth, person.truth, rng);
  return cloud;
}

float spread_of_depth(const DepthCamera& camera) {
  const LabelledPoints cloud = seen(wall(), {{camera}, {}});
  return std::sqrt(cloud.points.col(2).squaredNorm() / static_cast<float>(cloud.points.rows()));
}

TEST(DepthCamera, WithoutFaultsGivesSurfacePoints) {
  EXPECT_LT(spread_of_depth(facing(2)), 1e-4f);
  EXPECT_EQ(seen(wall(), {{facing(2)}, {}}).points.rows(), 6000);
}

TEST(DepthCamera, NoiseGrowsWithTheSquareOfDistance) {
  DepthCamera near = facing(1), far = facing(3);
  near.noise = far.noise = 0.002f;
  EXPECT_NEAR(spread_of_depth(near), 0.002f, 0.0003f);
  EXPECT_NEAR(spread_of_depth(far), 0.018f, 0.002f);
}

TEST(DepthCamera, StructuredLightHasSteps) {
  DepthCamera camera = facing(3);
  camera.step = 0.003f;
  std::set<long> disparities;
  const LabelledPoints cloud = seen(wall(), {{camera}, {}});
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const float inverse = 1 / ((cloud.points.row(i).transpose() - camera.eye).norm() * camera.step);
    EXPECT_NEAR(inverse, std::round(inverse), 0.01f);
    disparities.insert(std::lround(inverse));
  }
  EXPECT_LE(disparities.size(), 4u);
}

TEST(DepthCamera, FlyingPixelsAreBehindEdgesAndNoLongerBody) {
  DepthCamera camera = facing(2);
  camera.flying = 1;
  const LabelledPoints cloud = seen(wall(), {{camera}, {}});
  int flying = 0;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const float distance = (cloud.points.row(i).transpose() - camera.eye).norm();
    const float behind = distance - distance * 2 / (2 - cloud.points(i, 2));  // along the ray
    EXPECT_GT(behind, -1e-3f);
    EXPECT_EQ(cloud.parts[i] == kNoBody, behind > 0.04f) << behind;
    flying += behind > 0.001f;
    const float to_edge = 0.3f - cloud.points.row(i).leftCols(2).cwiseAbs().maxCoeff();
    if (to_edge > 0.08f) EXPECT_LT(behind, 1e-3f);
  }
  EXPECT_GT(flying, 300);
}

TEST(DepthCamera, SeesOneSideAndSeveralSeeAll) {
  const StandingPerson person;
  DepthRig rig;
  const auto look_from = [&](float x, float z) {
    DepthCamera camera = facing(1);
    camera.eye = Vec3(x, 0.3f, z);
    rig.cameras.push_back(camera);
  };
  look_from(0, 2.5f);
  const LabelledPoints front = seen(person.cloud, rig);
  EXPECT_LT(front.points.rows(), 0.85f * person.cloud.points.rows());
  float chest = 0;
  for (Eigen::Index i = 0; i < front.points.rows(); ++i)
    if (front.parts[i] == Spine2) chest += front.points(i, 2) - person.joint(Spine2).z();
  EXPECT_GT(chest / static_cast<float>(count_of(front, Spine2)), 0.02f);
  look_from(2.5f, 0), look_from(-2.5f, 0), look_from(0, -2.5f);
  EXPECT_GT(seen(person.cloud, rig).points.rows(), 0.7f * person.cloud.points.rows());
}

TEST(DepthCamera, ReadsNothingBehindAWallOrOutOfItsView) {
  const LabelledPoints near = wall();
  SeenSurface surface{Points(3 * near.points.rows(), 3), {}, {}};
  const Eigen::RowVector3f back(0, 0, -1), behind(0, 0, 3);  // the camera is at z = 2
  surface.now << near.points, near.points.rowwise() + back, near.points.rowwise() + behind;
  surface.beside = surface.now;
  surface.returned.assign(surface.now.rows(), 1);
  DepthCamera camera = facing(2);
  camera.widest = 0.1f;  // 20 cm to either side at the wall
  Rng rng(3);
  const auto readings = depth_readings(surface, {camera}, rng);
  ASSERT_GT(readings.size(), 1000u);
  for (const DepthReading& reading : readings) {
    ASSERT_LT(reading.row, near.points.rows());
    EXPECT_LT(surface.now.row(reading.row).leftCols(2).cwiseAbs().maxCoeff(), 0.201f);
    EXPECT_LT((reading.place.transpose() - surface.now.row(reading.row)).norm(), 1e-4f);
  }
}

TEST(DepthCamera, ThatIsLateSeesPeopleWhereTheyWere) {
  const StandingPerson person;
  DepthCamera camera = facing(2.5f);
  camera.late = 0.4f;
  PosedSkeleton beside = person.truth;
  beside.joints.col(0).array() += 0.1f;
  LabelledPoints in_time = person.cloud, late = person.cloud;
  Rng one(5), same(5);
  see_with_depth_cameras(late, {{camera}, {}}, person.truth, beside, one);
  see_with_depth_cameras(in_time, {{camera}, {}}, person.truth, person.truth, same);
  ASSERT_EQ(late.points.rows(), in_time.points.rows());
  const Points moved = late.points - in_time.points;
  EXPECT_NEAR(moved.col(0).mean(), 0.04f, 1e-4f);
  EXPECT_LT(moved.rightCols(2).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(DepthCamera, LosesBlackClothAndHairAndNothingElse) {
  const StandingPerson person;
  DepthRig rig;
  for (const float z : {2.5f, -2.5f}) rig.cameras.push_back(facing(z));
  const LabelledPoints all = seen(person.cloud, rig);
  rig.dark.group = 0;
  rig.dark.left = 0;
  rig.dark.edge = -1.1f;
  const LabelledPoints trousers = seen(person.cloud, rig);
  EXPECT_EQ(count_of(trousers, LeftHip) + count_of(trousers, LeftKnee), 0);
  EXPECT_EQ(count_of(trousers, Spine2), count_of(all, Spine2));
  rig.dark = {};
  rig.dark.is_hair_lost = true;
  rig.dark.left = 0;
  const LabelledPoints bald = seen(person.cloud, rig);
  EXPECT_LT(count_of(bald, Head), 0.85f * count_of(all, Head));
  EXPECT_GT(count_of(bald, Head), 0.1f * count_of(all, Head));
}

TEST(DepthRig, AloneIsAlignedAndOthersAreNotByMuch) {
  const StandingPerson person;
  std::set<size_t> counts;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const DepthRig rig = random_depth_rig(person.truth, rng);
    counts.insert(rig.cameras.size());
    for (const DepthCamera& camera : rig.cameras) {
      EXPECT_LE(camera.shift.norm(), 0.0301f);
      EXPECT_LE(std::abs(camera.late), 0.45f);
      if (rig.cameras.size() == 1) EXPECT_EQ(camera.shift.norm(), 0);
      if (rig.cameras.size() == 1) EXPECT_EQ(camera.late, 0);
    }
  }
  EXPECT_GE(counts.size(), 5u);
  EXPECT_EQ(*counts.rbegin(), 10u);
}

TEST(DepthRig, HasTheCamerasAndPlaceThatAreWanted) {
  for (const int cameras : {1, 3, 10}) {
    Rng rng(9);
    const DepthRig rig = random_depth_rig({cameras, Vec3(1, 2, 3), 2, 2.5f}, rng);
    ASSERT_EQ(rig.cameras.size(), static_cast<size_t>(cameras));
    for (const DepthCamera& camera : rig.cameras) {
      EXPECT_LT((camera.at - Vec3(1, 2, 3)).norm(), 0.6f);
      const Vec3 away = camera.eye - Vec3(1, 2, 3);
      EXPECT_GT(std::hypot(away.x(), away.z()), 1.7f);
      EXPECT_LT(std::hypot(away.x(), away.z()), 2.9f);
    }
  }
}

TEST(DepthRig, PointsStayNearTheBodyAndLabelsTrue) {
  const StandingPerson person;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed);
    const DepthRig rig = random_depth_rig(person.truth, rng);
    LabelledPoints cloud = person.cloud;
    see_with_depth_cameras(cloud, rig, person.truth, person.truth, rng);
    ASSERT_EQ(cloud.parts.size(), static_cast<size_t>(cloud.points.rows()));
    ASSERT_TRUE(cloud.points.allFinite());
    const auto nearest = nearest_neighbours(person.cloud.points, cloud.points, 1);
    int far = 0, labelled = 0;
    for (int i = 0; i < cloud.points.rows(); ++i) {
      if (cloud.parts[i] == kNoBody) continue;
      ++labelled;
      far += (cloud.points.row(i) - person.cloud.points.row(nearest(i, 0))).norm() > 0.13f;
    }
    EXPECT_LT(far, 0.03 * labelled);
  }
}

TEST(DepthRig, IsTheSameForTheSameRandomNumbers) {
  const StandingPerson person;
  const auto once = [&] {
    Rng rng(7);
    const DepthRig rig = random_depth_rig(person.truth, rng);
    LabelledPoints cloud = person.cloud;
    see_with_depth_cameras(cloud, rig, person.truth, person.truth, rng);
    return cloud.points;
  };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace understudy
