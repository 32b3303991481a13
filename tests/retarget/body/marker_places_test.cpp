#include "retarget/body/marker_places.hpp"

#include <gtest/gtest.h>

#include <set>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

TEST(MarkerPlaces, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (int m = 0; m < kMarkerCount; ++m) {
    EXPECT_EQ(marker_named(kMarkerPlaces[m].name), m);
    names.insert(kMarkerPlaces[m].name);
  }
  EXPECT_EQ(names.size(), size_t{kMarkerCount});
  EXPECT_EQ(marker_named("nose"), -1);
}

TEST(MarkerPlaces, LieOnTheSkinOfPeopleOfAnySize) {
  const ShapedBody person = builtin_person();
  for (const float size : {1.0f, 0.6f}) {
    const Points vertices = size * person.vertices;
    const Joints joints = size * person.joints;
    const MarkerPoints points = marker_points(joints);
    const std::vector<int> marked = marker_vertices(vertices, joints);
    ASSERT_EQ(marked.size(), size_t{kMarkerCount});
    EXPECT_EQ(std::set<int>(marked.begin(), marked.end()).size(), size_t{kMarkerCount});
    for (int m = 0; m < kMarkerCount; ++m)
      EXPECT_LT((points.row(m) - vertices.row(marked[m])).norm(), 0.025f * size) << kMarkerPlaces[m].name;
  }
}

TEST(MarkerPlaces, OfOneSideAreTheMirrorImageOfTheOther) {
  const Joints rest = builtin_joints();
  const MarkerPoints points = marker_points(rest);
  for (int m = 2; m < kMarkerCount; m += 2) {
    EXPECT_EQ(std::string(kMarkerPlaces[m].name).substr(5), std::string(kMarkerPlaces[m + 1].name).substr(6));
    Eigen::RowVector3f right = points.row(m + 1);
    right.x() *= -1;
    EXPECT_LT((points.row(m) - right).norm(), 0.01f) << kMarkerPlaces[m].name;
  }
}

TEST(MarkerPlaces, MoveWithTheirJoints) {
  const Joints rest = builtin_joints();
  Pose pose;
  pose.local[LeftKnee] = rotation_from_axis_angle(Vec3(1, 0, 0));
  pose.root = Vec3(1, 2, 3);
  const MarkerPoints still = marker_points(rest, {identity_rotations(), pose.root}),
                     bent = marker_points(rest, pose);
  const int knee = marker_named("left_knee"), ankle = marker_named("left_ankle");
  EXPECT_GT((bent.row(ankle) - still.row(ankle)).norm(), 0.2f);
  EXPECT_EQ(bent.row(marker_named("right_ankle")), still.row(marker_named("right_ankle")));
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  EXPECT_NEAR((bent.row(knee) - posed.joints.row(LeftKnee)).norm(),
              (still.row(knee) - posed.joints.row(LeftKnee)).norm(), 1e-5f);
}

TEST(MarkerPlaces, AreNotPutOnNothing) {
  EXPECT_THROW(marker_vertices(Points(0, 3), builtin_joints()), Error);
}

}  // namespace
}  // namespace understudy
