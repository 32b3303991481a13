#include "render/scene.hpp"
#include "render/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/colors.hpp"
#include "render/floor_shadow.hpp"
#include "retarget/base/error.hpp"
#include "tests/render/content.hpp"

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

TEST(SkeletonSolids, MarkJointsInTheirColours) {
  SkeletonView view = skeleton_view(make_joints());
  view.colors = Points::Zero(view.joints.rows(), 3);
  view.colors.row(LeftElbow) << 1, 0, 1;
  const MeshView solids = skeleton_solids(view);
  Points marked(0, 3);
  for (Eigen::Index i = 0; i < solids.vertices->rows(); ++i)
    if (solids.colors->row(i) == view.colors.row(LeftElbow)) {
      marked.conservativeResize(marked.rows() + 1, 3);
      marked.bottomRows<1>() = solids.vertices->row(i);
    }
  ASSERT_GT(marked.rows(), 0);
  EXPECT_LT((marked.rowwise() - view.joints.row(LeftElbow)).rowwise().norm().maxCoeff(), 0.05f);
  view.colors.conservativeResize(3, 3);
  EXPECT_THROW(skeleton_solids(view), Error);
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

double brightness(const Vec3& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

TEST(ErrorColors, DarkenWithTheErrorSoThatAnyEyeCanOrderThem) {
  Points colors = colors_along(error_color, Eigen::VectorXf::LinSpaced(11, 0, 0.05f), 0, 0.05f);
  for (Eigen::Index i = 1; i < colors.rows(); ++i)
    EXPECT_LT(brightness(colors.row(i)), brightness(colors.row(i - 1)) - 0.02) << i;
  EXPECT_GT(brightness(colors.row(0)), 0.9);
  EXPECT_LT(brightness(colors.row(10)), 0.1);
}

TEST(DivergingColors, AreBlueBelowBrightInTheMiddleAndOrangeAbove) {
  const Points colors = colors_along(diverging_color, Eigen::Vector3f(-1, 0, 1), -1, 1);
  EXPECT_GT(colors(0, 2), colors(0, 0) + 0.3f);
  EXPECT_GT(brightness(colors.row(1)), 0.9);
  EXPECT_GT(colors(2, 0), colors(2, 2) + 0.3f);
  EXPECT_TRUE(diverging_color(-7).isApprox(diverging_color(0)));
}

TEST(Scales, ShowWhatIsNoNumberAsGrey) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto scale : {viridis, error_color, diverging_color})
    EXPECT_TRUE(scale(nan).isApprox(Vec3(0.5f, 0.5f, 0.5f)));
}

TEST(FloorShadow, IsDarkestUnderTheFeetAndNothingAtItsEdge) {
  Scene scene;
  add(scene, make_person(2000));
  const FloorShadow shadow = floor_shadow(scene);
  const auto at = [&](float x, float z) {
    const float cell = shadow.area.z() / FloorShadow::kSide;
    return shadow.dark[static_cast<size_t>((z - shadow.area.y()) / cell) * FloorShadow::kSide +
                       static_cast<size_t>((x - shadow.area.x()) / cell)];
  };
  EXPECT_GT(at(0.13f, 0.05f), 130);          // the left foot
  EXPECT_LT(at(0.6f, 0), at(0.13f, 0.05f));  // below the hand
  EXPECT_GT(at(0.6f, 0), at(0.6f, 0.5f));
  for (int i = 0; i < FloorShadow::kSide; ++i) EXPECT_EQ(shadow.dark[static_cast<size_t>(i)], 0);
}

TEST(FloorShadow, ClosesLargeTriangles) {
  Scene scene;
  Points corners(3, 3);
  corners << -1, 0.1f, -1, 1, 0.1f, -1, 0, 0.1f, 1;
  Faces face(1, 3);
  face << 0, 1, 2;
  add(scene, Mesh{corners, face});
  const FloorShadow shadow = floor_shadow(scene);
  const auto middle =
      static_cast<size_t>(FloorShadow::kSide / 2 * FloorShadow::kSide + FloorShadow::kSide / 2);
  EXPECT_GT(shadow.dark[middle], 120);
}

TEST(Box, HasTwelveEdgesAlongTheAxes) {
  const LinesView view = box(Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3::Zero());
  ASSERT_EQ(view.positions.rows(), 24);
  EXPECT_FALSE(view.connected);
  float length = 0;
  for (Eigen::Index i = 0; i < 24; i += 2) {
    const Eigen::RowVector3f edge = view.positions.row(i + 1) - view.positions.row(i);
    EXPECT_EQ((edge.array() != 0).count(), 1);
    length += edge.norm();
  }
  EXPECT_FLOAT_EQ(length, 4 * (1 + 2 + 3));
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
