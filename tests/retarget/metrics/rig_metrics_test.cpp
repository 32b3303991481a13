#include "retarget/metrics/rig_metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/math/cheapest_pairs.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy {
namespace {

double figure(const std::vector<std::pair<std::string, double>>& figures, const std::string& key) {
  for (const auto& [name, value] : figures)
    if (name == key) return value;
  return NAN;
}

/// A body of one metre's diagonal that stands still, with these joints below a root, in two frames.
RigTruth with_joints(const std::vector<Vec3>& joints) {
  RigTruth truth;
  Points box(2, 3);
  box << 0, 0, 0, 1, 0, 0;
  truth.vertices = {box, box};
  truth.rest = box;
  Points places(1 + joints.size(), 3);
  places.row(0).setZero();
  for (size_t j = 0; j < joints.size(); ++j) places.row(1 + j) = joints[j].transpose();
  truth.joints = {places, places};
  truth.parents.assign(places.rows(), 0);
  truth.parents[0] = -1;
  truth.weights = RowMatrix::Zero(2, places.rows());
  truth.weights.col(0).setOnes();
  truth.bones.assign(2, BoneMotions(places.rows()));
  truth.axes.assign(places.rows(), Vec3::Zero());
  return truth;
}

TEST(RigTruth, MergesWhatHardlyTurnsAndSlides) {
  RiggedMotion arm = test::bending_arm();
  const double size = body_size(truth_of(arm).vertices);
  EXPECT_EQ(merged_truth(truth_of(arm)).count(), 3);
  for (size_t t = 0; t < arm.motion.poses.size(); ++t)
    arm.motion.poses[t].turns[1] =
        rotation_from_axis_angle({0, 0, kPi / 180 * (t % 2 == 0 ? -2.0f : 2.0f)});  // 4 degrees in all
  const RigTruth merged = merged_truth(truth_of(arm));
  ASSERT_EQ(merged.count(), 2);
  EXPECT_EQ(merged.parents, (std::vector<int>{-1, 0}));
  EXPECT_EQ(merged.joints[0].row(1), truth_of(arm).joints[0].row(2));  // the wrist stays
  EXPECT_EQ(merged.weights(100, 0), 1);                                // x = 1.2: of the elbow's bone before
  for (size_t t = 0; t < arm.motion.poses.size(); ++t)
    arm.motion.poses[t].turns[1] = rotation_from_axis_angle({0, 0, kPi / 180 * (t % 2 == 0 ? -3.0f : 3.0f)});
  EXPECT_EQ(merged_truth(truth_of(arm)).count(), 3);
  for (auto& joint : arm.rig.joints)
    if (joint.name == "elbow") joint.kind = JointKind::Slider;
  for (size_t t = 0; t < arm.motion.poses.size(); ++t) {
    arm.motion.poses[t].turns[1].setIdentity();
    arm.motion.poses[t].slides[1] = t == 3 ? static_cast<float>(0.009 * size) : 0;
  }
  EXPECT_EQ(merged_truth(truth_of(arm)).count(), 2);
  arm.motion.poses[3].slides[1] = static_cast<float>(0.012 * size);
  EXPECT_EQ(merged_truth(truth_of(arm)).count(), 3);
}

TEST(RigTruth, SizeIsTheMeanDiagonal) {
  Points small(2, 3), large(2, 3);
  small << 0, 0, 0, 1, 2, 2;
  large << 1, 1, 1, 1, 4, 5;
  EXPECT_DOUBLE_EQ(body_size({small, large}), 4);
  EXPECT_THROW(body_size({}), Error);
  EXPECT_THROW(body_size({Points::Zero(3, 3)}), Error);
}

TEST(RigTruth, SaysWhatDoesNotFit) {
  const RigTruth good = truth_of(test::bending_arm());
  EXPECT_NO_THROW(check_rig_truth(good));
  const auto refuses = [&](auto spoil) {
    RigTruth bad = good;
    spoil(bad);
    EXPECT_THROW(check_rig_truth(bad), Error);
  };
  refuses([](RigTruth& truth) { truth.parents[1] = 2; });
  refuses([](RigTruth& truth) { truth.axes.pop_back(); });
  refuses([](RigTruth& truth) { truth.bones.pop_back(); });
  refuses([](RigTruth& truth) { truth.joints[1].conservativeResize(2, 3); });
  refuses([](RigTruth& truth) { truth.weights.conservativeResize(Eigen::NoChange, 2); });
  refuses([](RigTruth& truth) { truth.vertices[2](0, 0) = NAN; });
  refuses([](RigTruth& truth) { truth.faces(0, 0) = 1000; });
}

// True joints at 0.2, 0.5, 0.9 m of a body of 1 m; found ones 1 cm, 3 cm and 20 cm off, and one more.
TEST(JointPairs, CountWhatIsNear) {
  const RigTruth truth = with_joints({{0.2f, 0, 0}, {0.5f, 0, 0}, {0.9f, 0, 0}}),
                 found = with_joints({{0.9f, 0.2f, 0}, {0.5f, 0.03f, 0}, {0.2f, 0, 0.01f}, {0, 3, 0}});
  const JointPairs pairs = pair_joints(found, truth);
  EXPECT_EQ(pairs.found, (std::vector<int>{-1, 3, 2, 1}));
  EXPECT_NEAR(pairs.e[3], 0.2, 1e-6);
  EXPECT_NEAR(pairs.recall(), 2.0 / 3, 1e-9);
  EXPECT_NEAR(pairs.precision(), 2.0 / 4, 1e-9);
  EXPECT_NEAR(pairs.error_pct(), 2, 1e-4);  // the median of 1 and 3
}

// A leg's last joint is missed and one before its first is too many: together all three would be nearer if
// each went one further.
TEST(JointPairs, OfAChainStayWhereTheyAreNear) {
  const RigTruth truth = with_joints({{0.3f, 0, 0}, {0.6f, 0, 0}, {0.9f, 0, 0}}),
                 found = with_joints({{0, 0, 0}, {0.31f, 0, 0}, {0.61f, 0, 0}});
  const JointPairs pairs = pair_joints(found, truth);
  EXPECT_EQ(pairs.found, (std::vector<int>{-1, 2, 3, 1}));
  EXPECT_NEAR(pairs.recall(), 2.0 / 3, 1e-9);
}

TEST(JointPairs, WithoutJointsAreUndefined) {
  const RigTruth none = with_joints({}), one = with_joints({{0.5f, 0, 0}});
  EXPECT_TRUE(std::isnan(pair_joints(one, none).recall()));
  EXPECT_EQ(pair_joints(one, none).precision(), 0);
  EXPECT_EQ(pair_joints(none, one).recall(), 0);
  EXPECT_EQ(pair_joints(none, one).precision(), 0);
  EXPECT_TRUE(std::isnan(pair_joints(none, none).precision()));
  EXPECT_TRUE(std::isnan(pair_joints(none, one).error_pct()));
  RigTruth longer = one;
  longer.vertices.push_back(one.vertices[0]);
  EXPECT_THROW(pair_joints(one, longer), Error);
}

TEST(HingeError, IsTheAngleBetweenAxes) {
  const RiggedMotion arm = test::bending_arm();
  const RigTruth truth = truth_of(arm);
  const JointPairs pairs = pair_joints(truth, truth);
  EXPECT_NEAR(hinge_error_deg(arm, truth, pairs), 0, 1e-3);
  RiggedMotion tilted = arm;  // as a ball it turns about z all the same
  tilted.rig.joints[1].kind = JointKind::Ball;
  EXPECT_NEAR(hinge_error_deg(tilted, truth, pairs), 0, 1e-2);
  tilted.rig.joints[1].kind = JointKind::Hinge;
  tilted.rig.joints[1].axis = Vec3(0, std::sin(kPi / 9), -std::cos(kPi / 9));  // 20 degrees, the other way
  EXPECT_NEAR(hinge_error_deg(tilted, truth, pairs), 20, 1e-3);
  tilted.rig.joints[1].kind = JointKind::Ball;
  for (RigPose& pose : tilted.motion.poses) pose.turns[1].setIdentity();
  EXPECT_NEAR(hinge_error_deg(tilted, truth, pairs), 90, 1e-3);
}

// Of the 6 pairs of 4 points {0,1} and {2,3} are together in a, {1,2,3} in b; both agree on 3.
TEST(RandIndex, CountsPairs) {
  const RandIndex rand = rand_index({0, 0, 1, 1}, {0, 1, 1, 1});
  EXPECT_NEAR(rand.plain, 3.0 / 6, 1e-12);
  EXPECT_NEAR(rand.adjusted, 0, 1e-12);  // one pair together in both, as chance gives: 2 * 3 / 6
  EXPECT_EQ(rand_index({0, 0, 1, 2}, {5, 5, 0, 1}).plain, 1);
  EXPECT_EQ(rand_index({0, 0, 1, 2}, {5, 5, 0, 1}).adjusted, 1);
  EXPECT_EQ(rand_index({0, 0}, {0, 0}).adjusted, 1);
  EXPECT_THROW(rand_index({0}, {0}), Error);
  EXPECT_THROW(rand_index({0, 1}, {0, 1, 2}), Error);
  EXPECT_THROW(rand_index({0, -1}, {0, 1}), Error);
}

// A chain of four found as a chain of three and a part that hangs elsewhere: edges 0-1 and 1-2 are right.
TEST(TreeF1, CountsEdgesBetweenPartners) {
  const std::vector<int> chain = {-1, 0, 1, 2}, star = {-1, 0, 1, 0};
  const PartLabels labels{{0, 1, 2, 3}, {0, 1, 2, 3}};
  EXPECT_NEAR(tree_f1(star, chain, labels), 2.0 * 2 / 6, 1e-12);
  EXPECT_EQ(tree_f1(chain, chain, labels), 1);
  EXPECT_EQ(tree_f1({-1, 0, 1, 2}, chain, {{3, 2, 1, 0}, {0, 1, 2, 3}}), 1);  // its root at the other end
  EXPECT_EQ(tree_f1({-1}, {-1}, {{0, 0}, {0, 0}}), 1);
  EXPECT_EQ(tree_f1({-1}, chain, {{0, 0, 0, 0}, {0, 1, 2, 3}}), 0);
}

TEST(TreeF1, LooksThroughPartsWithoutPoints) {
  EXPECT_EQ(tree_f1({-1, 0}, {-1, 0, 1}, {{0, 1}, {0, 2}}), 1);
  EXPECT_EQ(tree_f1({-1, 0}, {-1, 0, 0}, {{0, 1}, {1, 2}}), 1);  // the true root is nowhere seen
}

TEST(TrackError, IsTheShareOfTheBody) {
  const RigTruth truth = truth_of(test::bending_arm());
  EXPECT_NEAR(track_error_pct(truth, 2, truth), 0, 1e-3);
  RigTruth slid = truth;  // from frame 3 on 1 % of the body too high
  const auto by = static_cast<float>(0.01 * body_size(truth.vertices));
  for (int t = 3; t < slid.frames(); ++t) slid.vertices[t].col(1).array() += by;
  EXPECT_NEAR(track_error_pct(slid, 0, truth), 4.0 / 7, 1e-3);
  EXPECT_THROW(track_error_pct(truth, 7, truth), Error);
}

TEST(SurfaceError, IsTheMeanOfBothWays) {
  Points square(4, 3), lifted(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  lifted = square.rowwise() + Eigen::RowVector3f(0, 0, 0.1f);
  Faces faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  EXPECT_NEAR(surface_error_pct({lifted}, faces, {Mesh{square, faces}}, 2), 100 * 0.1 / 2, 1e-3);
  EXPECT_NEAR(surface_error_pct({lifted, square}, faces, {Mesh{square, faces}, Mesh{Points(0, 3)}}, 2), 5,
              1e-3);
  Points middle(1, 3);
  middle << 0.5f, 0.5f, 0.1f;  // of the square to the one point: its mean distance from the middle, 0.3826
  EXPECT_NEAR(surface_error_pct({lifted}, faces, {Mesh{middle}}, 1), 100 * 0.3826 / 2, 0.3);
  EXPECT_THROW(surface_error_pct({lifted}, faces, {}, 2), Error);
  EXPECT_THROW(surface_error_pct({}, faces, {}, 0), Error);
}

// Four corners of a square with a diagonal of one, one moved off by 0.2: no similarity mends all of it.
TEST(RetargetError, ForgivesASimilarityAlone) {
  const std::vector<Points> truth = {test::arm_surface().vertices};
  const Mat3 R = rotation_from_axis_angle({0.3f, 1, -0.4f});
  const Points similar = ((2 * truth[0] * R.transpose()).rowwise() + Eigen::RowVector3f(1, 2, 3));
  EXPECT_NEAR(retarget_error_pct({similar}, truth), 0, 1e-3);
  Points cross(4, 3), stretched(4, 3);
  cross << 0.5f, 0, 0, -0.5f, 0, 0, 0, 0.5f, 0, 0, -0.5f, 0;
  stretched = cross;
  stretched.col(0) *= 3;  // best scale 0.4: (1.5 + 0.5) / (2 * (2.25 + 0.25)); off by 0.1 and 0.3
  EXPECT_NEAR(retarget_error_pct({stretched}, {cross}), 100 * 0.2 / std::sqrt(2.0), 1e-3);
  EXPECT_THROW(retarget_error_pct({cross}, {cross, cross}), Error);
  EXPECT_THROW(retarget_error_pct({similar}, {cross}), Error);
}

// Two joints, two keypoints, four frames: the first joint has keypoint 0 in three of them, the second
// always 1.
TEST(SemanticConsistency, IsTheLargestShareOfAKeypoint) {
  Points keypoints(2, 3), swapped(2, 3), joints(2, 3);
  keypoints << 0, 0, 0, 1, 0, 0;
  joints << 0.1f, 0, 0, 0.9f, 0, 0;
  SemanticConsistency sc;
  EXPECT_TRUE(std::isnan(sc.value()));
  EXPECT_TRUE(sc.joints().empty());
  for (int t = 0; t < 3; ++t) sc.push(keypoints, joints);
  joints(0, 0) = 0.8f;
  sc.push(keypoints, joints);
  EXPECT_NEAR(sc.value(), (0.75 + 1) / 2, 1e-12);
  ASSERT_EQ(sc.joints().size(), 2u);
  EXPECT_EQ(sc.joints()[0].keypoint, 0);
  EXPECT_NEAR(sc.joints()[0].share, 0.75, 1e-12);
  EXPECT_EQ(sc.joints()[1].keypoint, 1);
  EXPECT_THROW(sc.push(keypoints.topRows(1), joints), Error);
  EXPECT_THROW(sc.push(Points(0, 3), joints), Error);
}

TEST(RigFigures, OfTheTruthArePerfect) {
  const RiggedMotion arm = test::bending_arm();
  const auto figures = rig_figures(arm, 0, test::scans_of(arm), truth_of(arm));
  for (const char* key : {"joint_recall", "joint_precision", "part_ri", "part_ari", "tree_f1", "sc"})
    EXPECT_EQ(figure(figures, key), 1) << key;
  for (const char* key : {"joint_error_pct", "hinge_deg", "track_pct", "surface_pct"})
    EXPECT_NEAR(figure(figures, key), 0, 2e-3) << key;
  EXPECT_LT(figure(figures, "cd_1e4"), 1.5);  // points are drawn
  EXPECT_LT(figure(figures, "m_cd"), 0.01);
  EXPECT_EQ(figure(figures, "true_parts"), 3);
  EXPECT_EQ(figure(figures, "sc_keypoints"), 3);
}

TEST(RigFigures, SeeAMissingJoint) {
  const RiggedMotion arm = test::bending_arm();
  RiggedMotion stiff = arm;  // without a wrist
  stiff.rig.joints.pop_back();
  for (int& bone : stiff.rig.skin.bones.reshaped()) bone = std::min(bone, 1);
  for (RigPose& pose : stiff.motion.poses) pose.turns.pop_back(), pose.slides.pop_back();
  const auto figures = rig_figures(stiff, 0, test::scans_of(arm), truth_of(arm));
  EXPECT_EQ(figure(figures, "joint_recall"), 0.5);
  EXPECT_EQ(figure(figures, "joint_precision"), 1);
  EXPECT_EQ(figure(figures, "found_parts"), 2);
  EXPECT_NEAR(figure(figures, "part_ri"), 7.0 / 9, 0.01);  // two of three equal parts are one
  EXPECT_GT(figure(figures, "track_pct"), 1);
  EXPECT_GT(figure(figures, "cd_1e4"), 10);
  RiggedMotion shorter = arm;
  shorter.motion.poses.pop_back();
  EXPECT_THROW(rig_figures(shorter, 0, test::scans_of(arm), truth_of(arm)), Error);
  EXPECT_THROW(rig_figures(arm, 0, test::scans_of(shorter), truth_of(arm)), Error);
}

}  // namespace
}  // namespace understudy
