#include "render/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "content.hpp"
#include "render/colors.hpp"
#include "render/passes/skeleton_pass.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

TEST(AllPoints, LeavesOutWhatIsNotFinite) {
  Scene scene;
  add(scene, make_pear());
  const auto before = all_points(scene).rows();
  Points vertices = scene.meshes[0].vertices;
  vertices(3, 0) = std::numeric_limits<float>::infinity();
  scene.meshes[0].vertices = vertices;
  EXPECT_EQ(all_points(scene).rows(), before - 1);
}

TEST(SkeletonView, KnowsTheSides) {
  const SkeletonView view = skeleton_view(make_joints());
  EXPECT_EQ(view.sides[Head], Side::Middle);
  EXPECT_EQ(view.sides[LeftWrist], Side::Left);
  EXPECT_EQ(view.sides[RightFoot], Side::Right);
}

TEST(SkeletonSolids, SurroundTheJointsWithUnitNormalsOutward) {
  const SkeletonView view = skeleton_view(make_joints());
  const MeshView solids = skeleton_solids(view);
  EXPECT_TRUE(solids.normals->rowwise().norm().isOnes(1e-4f));
  const Points faces = vertex_normals(solids.vertices, solids.faces);
  EXPECT_GT(faces.cwiseProduct(*solids.normals).rowwise().sum().mean(), 0.6f);
  for (Eigen::Index i = 0; i < solids.vertices->rows(); ++i) EXPECT_GT((*solids.vertices)(i, 1), -0.05f);
}

TEST(SkeletonSolids, LeaveOutAJointThatIsNotFinite) {
  SkeletonView view = skeleton_view(make_joints());
  const auto before = skeleton_solids(view).vertices->rows();
  view.joints(LeftElbow, 0) = std::numeric_limits<float>::quiet_NaN();
  const MeshView solids = skeleton_solids(view);
  EXPECT_LT(solids.vertices->rows(), before);
  EXPECT_TRUE(solids.vertices->allFinite());
}

TEST(SkeletonSolids, RefuseAParentThatIsNone) {
  SkeletonView view = skeleton_view(make_joints());
  view.parents[4] = 22;
  EXPECT_THROW(skeleton_solids(view), Error);
}

TEST(Viridis, RunsFromPurpleToYellowAndClamps) {
  EXPECT_TRUE(viridis(0).isApprox(Vec3(0.267f, 0.005f, 0.329f), 0.05f));
  EXPECT_TRUE(viridis(0.5f).isApprox(Vec3(0.128f, 0.567f, 0.551f), 0.05f));
  EXPECT_TRUE(viridis(1).isApprox(Vec3(0.993f, 0.906f, 0.144f), 0.05f));
  EXPECT_EQ(viridis(-3), viridis(0));
}

TEST(WeightColors, OfOneJointAreItsCategory) {
  const RowMatrix weights = RowMatrix::Identity(22, 22);
  const Points colors = weight_colors(weights);
  for (int j = 0; j < 22; ++j) EXPECT_TRUE(colors.row(j).transpose().isApprox(kCategories[j], 1e-5f));
}

TEST(Categories, AreAllDifferent) {
  for (size_t i = 0; i < kCategories.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_GT((kCategories[i] - kCategories[j]).norm(), 0.08f) << i << " " << j;
}

}  // namespace
}  // namespace understudy::render
