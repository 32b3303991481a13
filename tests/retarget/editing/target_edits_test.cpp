#include "retarget/editing/target_edits.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct Person {
  ShapedBody body = builtin_person();
  Mesh mesh{body.vertices, body.faces, Points(0, 3)};
  Neighbours neighbours = Neighbours::from(mesh);
  PaintSurface surface{mesh.vertices, neighbours};
  /// The vertex nearest to a place.
  int vertex(const Vec3& at) const {
    Eigen::Index best;
    (mesh.vertices.rowwise() - at.transpose()).rowwise().squaredNorm().minCoeff(&best);
    return static_cast<int>(best);
  }
  Vec3 at(int v) const { return mesh.vertices.row(v).transpose(); }
};

const Person& person() {
  static const Person p;
  return p;
}

void expect_weights(const RowMatrix& w) {
  EXPECT_GE(w.minCoeff(), 0);
  EXPECT_LT((w.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f);
}

/// A place on the inside of the left thigh, 10 cm below where the legs part.
Vec3 inner_thigh() {
  const Points& p = person().mesh.vertices;
  float crotch = 9;
  for (Eigen::Index v = 0; v < p.rows(); ++v)
    if (std::abs(p(v, 0)) < 1e-4f) crotch = std::min(crotch, p(v, 1));
  return person().at(person().vertex(Vec3(0.01f, crotch - 0.1f, person().body.joints(LeftKnee, 2))));
}

TEST(JointMove, TakesTheMirrorJointAlong) {
  const Joints rest = builtin_joints();
  const Vec3 to(0.3f, 0.5f, 0.02f);
  const Joints both = apply({JointMove{LeftElbow, to, true}}, rest);
  EXPECT_LT((both.row(LeftElbow).transpose() - to).norm(), 1e-6f);
  EXPECT_LT((both.row(RightElbow).transpose() - Vec3(-0.3f, 0.5f, 0.02f)).norm(), 1e-5f);
  const Joints one = apply({JointMove{LeftElbow, to, false}}, rest);
  EXPECT_EQ(one.row(RightElbow), rest.row(RightElbow));
  EXPECT_NEAR(apply({JointMove{Spine2, to, true}}, rest)(Spine2, 0), 0, 1e-5f);
}

TEST(JointMove, MirrorsAboutTheBodysOwnMiddle) {
  Joints rest = builtin_joints();
  rest.col(0).array() += 2;
  EXPECT_NEAR(symmetry_centre(rest), 2, 1e-5f);
  const Joints both = apply({JointMove{RightKnee, Vec3(1.9f, -0.4f, 0), true}}, rest);
  EXPECT_NEAR(both(LeftKnee, 0), 2.1f, 1e-5f);
  EXPECT_THROW(apply({JointMove{22, Vec3::Zero(), true}}, rest), Error);
}

TEST(RestPose, HasOneTurnABoneAndThatOfTheOtherSideInTheMirror) {
  std::vector<BoneTurn> pose = turned({}, {LeftShoulder, Vec3(0, 0, -0.5f)}, true);
  pose = turned(pose, {LeftShoulder, Vec3(0, 0.3f, 0)}, true);
  pose = turned(pose, {Spine2, Vec3(0.2f, 0, 0)}, true);
  ASSERT_EQ(pose.size(), 3u);
  Pose posed;
  posed.local = rest_rotations(pose);
  const Mat3 wanted =
      rotation_from_axis_angle(Vec3(0, 0, -0.5f)) * rotation_from_axis_angle(Vec3(0, 0.3f, 0));
  EXPECT_LT(geodesic_angle(posed.local[LeftShoulder], wanted), 1e-3f);
  const Pose mirror = mirrored(posed);
  for (const size_t j : {LeftShoulder, RightShoulder, Spine2})
    EXPECT_LT(geodesic_angle(posed.local[j], mirror.local[j]), 1e-3f);
  EXPECT_TRUE(turned({{Head, Vec3(0, 1, 0)}}, {Head, Vec3(0, -1, 0)}, false).empty());  // back to the T-pose
  EXPECT_THROW(rest_rotations({{22, Vec3::Zero()}}), Error);
  EXPECT_THROW(rest_rotations({{Head, Vec3(0, NAN, 0)}}), Error);
}

TEST(Neighbours, JoinSeamsAndKnowTheRing) {
  Mesh mesh;  // two triangles that touch only by vertices at equal places
  mesh.vertices.resize(6, 3);
  mesh.vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  mesh.faces.resize(2, 3);
  mesh.faces << 0, 1, 2, 3, 4, 5;
  const Neighbours n = Neighbours::from(mesh);
  const std::vector<int> of_1(n.index.begin() + n.start[1], n.index.begin() + n.start[2]);
  EXPECT_EQ(of_1, (std::vector<int>{0, 2, 3}));
  const std::vector<int> of_0(n.index.begin() + n.start[0], n.index.begin() + n.start[1]);
  EXPECT_EQ(of_0, (std::vector<int>{1, 2}));
}

TEST(Neighbours, OfACloudAreTheNearest) {
  Mesh cloud;
  cloud.vertices = person().mesh.vertices.topRows(500);
  const Neighbours n = Neighbours::from(cloud);
  const auto exact = nearest_neighbours(cloud.vertices, cloud.vertices, 7);
  for (int v = 0; v < 500; v += 37) {
    const std::vector<int> mine(n.index.begin() + n.start[static_cast<size_t>(v)],
                                n.index.begin() + n.start[static_cast<size_t>(v) + 1]);
    for (int k = 1; k < 7; ++k)
      EXPECT_TRUE(std::count(mine.begin(), mine.end(), exact(v, k))) << v << " " << k;
  }
}

TEST(Stroke, AddsTheMostAtTheHitAndKeepsRowsWeights) {
  const Vec3 hit = inner_thigh();
  const Brush brush{Head, 0.06f, 0.5f, BrushMode::Add};
  const WeightRows rows = stroke(person().body.weights, person().surface, hit, brush);
  ASSERT_GT(rows.vertex.size(), 20u);
  expect_weights(rows.rows);
  float nearest = 1, most = 0, at_most = 1;
  for (size_t i = 0; i < rows.vertex.size(); ++i) {
    const float d = (person().at(rows.vertex[i]) - hit).norm(),
                w = rows.rows(static_cast<Eigen::Index>(i), Head);
    EXPECT_LT(d, 0.06f);
    EXPECT_GT(w, 0);
    if (w > most) most = w, at_most = d;
    nearest = std::min(nearest, d);
  }
  EXPECT_NEAR(most, 0.5f, 0.01f);
  EXPECT_EQ(at_most, nearest);
  EXPECT_TRUE(std::is_sorted(rows.vertex.begin(), rows.vertex.end()));
}

TEST(Stroke, OnOneThighLeavesTheOther) {
  const Vec3 hit = inner_thigh();
  int near_other = 0;
  for (int v = 0; v < person().mesh.vertices.rows(); ++v)
    near_other += person().mesh.vertices(v, 0) < -0.005f && (person().at(v) - hit).norm() < 0.09f;
  ASSERT_GT(near_other, 10) << "the other thigh must be in the brush's ball for this test to say anything";
  const WeightRows rows =
      stroke(person().body.weights, person().surface, hit, {LeftKnee, 0.09f, 1, BrushMode::Add});
  ASSERT_GT(rows.vertex.size(), 20u);
  for (const int v : rows.vertex) EXPECT_GT(person().mesh.vertices(v, 0), -1e-6f);
}

TEST(Stroke, SubtractsDownToNothingAndGivesToTheParentWhatNobodyHas) {
  RowMatrix weights = RowMatrix::Zero(person().mesh.vertices.rows(), kJointCount);
  weights.col(LeftKnee).setOnes();
  const Vec3 hit = inner_thigh();
  const WeightRows rows = stroke(weights, person().surface, hit, {LeftKnee, 0.05f, 1, BrushMode::Subtract});
  ASSERT_FALSE(rows.empty());
  expect_weights(rows.rows);
  EXPECT_LT(rows.rows.col(LeftKnee).minCoeff(), 0.01f);
  EXPECT_GT(rows.rows.col(LeftHip).maxCoeff(), 0.99f);
}

TEST(Stroke, SmoothsAnEdge) {
  RowMatrix weights = RowMatrix::Zero(person().mesh.vertices.rows(), kJointCount);
  const Vec3 hit = inner_thigh();
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    weights(v, person().mesh.vertices(v, 1) > hit.y() ? LeftHip : LeftKnee) = 1;
  const auto steepest = [&](const RowMatrix& w) {
    float sum = 0;
    for (int v = 0; v < w.rows(); ++v) {
      if ((person().at(v) - hit).norm() > 0.03f) continue;
      for (int k = person().neighbours.start[static_cast<size_t>(v)];
           k < person().neighbours.start[static_cast<size_t>(v) + 1]; ++k)
        sum += (w.row(v) - w.row(person().neighbours.index[static_cast<size_t>(k)])).squaredNorm();
    }
    return sum;
  };
  const float before = steepest(weights);
  for (int dab = 0; dab < 10; ++dab)
    apply(stroke(weights, person().surface, hit, {0, 0.08f, 1, BrushMode::Smooth}), weights);
  EXPECT_LT(steepest(weights), 0.5f * before);
  expect_weights(weights);
}

TEST(Stroke, RefusesWhatDoesNotFit) {
  const RowMatrix small = RowMatrix::Zero(3, kJointCount);
  EXPECT_THROW(stroke(small, person().surface, Vec3::Zero(), {}), Error);
  Brush brush;
  brush.radius_m = 0;
  EXPECT_THROW(stroke(person().body.weights, person().surface, Vec3::Zero(), brush), Error);
  EXPECT_TRUE(stroke(person().body.weights, person().surface, Vec3(9, 9, 9), {}).empty());
}

TEST(WeightRows, MergeTheNewerOverTheOlder) {
  const Vec3 a = inner_thigh(), b = a + Vec3(0, 0.04f, 0);
  RowMatrix one_by_one = person().body.weights;
  const WeightRows first = stroke(one_by_one, person().surface, a, {Head, 0.06f, 0.5f, BrushMode::Add});
  apply(first, one_by_one);
  const WeightRows second = stroke(one_by_one, person().surface, b, {Neck, 0.06f, 0.5f, BrushMode::Add});
  apply(second, one_by_one);
  RowMatrix at_once = person().body.weights;
  const WeightRows both = merged(first, second);
  EXPECT_LT(both.vertex.size(), first.vertex.size() + second.vertex.size());
  apply(both, at_once);
  EXPECT_EQ(at_once, one_by_one);
  for (int v = 0; v < at_once.rows(); ++v)
    EXPECT_EQ(at_once.row(v) != person().body.weights.row(v),
              std::binary_search(both.vertex.begin(), both.vertex.end(), v));
}

TEST(WeightRows, GoToTheNearestVerticesOfAnotherSurface) {
  Points before(3, 3), after(2, 3);
  before << 0, 0, 0, 0.1f, 0, 0, 1, 0, 0;
  after << 1.02f, 0, 0, 0.05f, 0, 0;
  WeightRows rows;
  rows.vertex = {0, 1, 2};
  rows.rows = RowMatrix::Identity(3, kJointCount);
  EXPECT_THROW(reprojected(rows, after), Error);  // where they were painted is not known
  const WeightRows there = reprojected(placed(rows, before), after);
  EXPECT_EQ(there.vertex, (std::vector<int>{0, 1}));
  EXPECT_EQ(there.of, 2);
  EXPECT_EQ(there.places, after);
  EXPECT_FLOAT_EQ(there.rows(0, 2), 1);
  EXPECT_FLOAT_EQ(there.rows(1, 0), 0.5f);
  EXPECT_FLOAT_EQ(there.rows(1, 1), 0.5f);
  RowMatrix weights = RowMatrix::Zero(3, kJointCount);
  EXPECT_THROW(apply(there, weights), Error);  // painted on two vertices
}

TEST(WeightRows, RefuseVerticesThatAreNotThere) {
  WeightRows rows;
  rows.vertex = {5};
  rows.rows = RowMatrix::Zero(1, kJointCount);
  RowMatrix weights = RowMatrix::Zero(5, kJointCount);
  EXPECT_THROW(apply(rows, weights), Error);
}

TEST(MirroredWeights, OfASymmetricBodyGiveItsOtherSide) {
  RowMatrix damaged = person().body.weights;
  for (Eigen::Index v = 0; v < damaged.rows(); ++v)
    if (person().mesh.vertices(v, 0) < -1e-3f) {
      damaged.row(v).setZero();
      damaged(v, Head) = 1;
    }
  const WeightRows rows = mirrored_weights(damaged, person().mesh.vertices, BodySide::Left);
  apply(rows, damaged);
  expect_weights(damaged);
  EXPECT_LT((damaged - person().body.weights).cwiseAbs().maxCoeff(), 2e-2f);
  EXPECT_LT((damaged - person().body.weights).cwiseAbs().mean(), 1e-5f);
}

TEST(MirroredWeights, LeaveTheSideTheyComeFrom) {
  RowMatrix weights = person().body.weights;
  apply(stroke(weights, person().surface, inner_thigh(), {Head, 0.06f, 0.9f, BrushMode::Add}), weights);
  const WeightRows rows = mirrored_weights(weights, person().mesh.vertices, BodySide::Left);
  ASSERT_FALSE(rows.empty());
  for (const int v : rows.vertex) EXPECT_LT(person().mesh.vertices(v, 0), 1e-3f);
  RowMatrix both = weights;
  apply(rows, both);
  const Vec3 other(-inner_thigh().x(), inner_thigh().y(), inner_thigh().z());
  EXPECT_GT(both(person().vertex(other), Head), 0.85f);
}

TEST(MirroredWeights, OfALopsidedBodyComeToAnEnd) {
  Points vertices = person().mesh.vertices;
  for (Eigen::Index v = 0; v < vertices.rows();
       ++v)  // the left half shrinks to a hand's size: images are far off
    if (vertices(v, 0) > 1e-3f) vertices.row(v) = 0.1f * vertices.row(v) + Eigen::RowVector3f(1, 0, 0);
  const WeightRows rows = mirrored_weights(person().body.weights, vertices, BodySide::Left);
  expect_weights(rows.rows);
  vertices(3, 1) = NAN;
  EXPECT_THROW(mirrored_weights(person().body.weights, vertices, BodySide::Left), Error);
}

TEST(SmoothedWeights, FlattenAndStayWeights) {
  RowMatrix weights = RowMatrix::Zero(person().mesh.vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) weights(v, v % 2 ? Head : Neck) = 1;
  const float before = (weights.col(Head).array() - 0.5f).square().mean();
  apply(smoothed(weights, person().neighbours, {}, 0.7f, 5), weights);
  expect_weights(weights);
  EXPECT_LT((weights.col(Head).array() - 0.5f).square().mean(), 0.2f * before);
  EXPECT_EQ(smoothed(weights, person().neighbours, {3, 4}, 1).vertex.size(), 2u);
}

}  // namespace
}  // namespace understudy
