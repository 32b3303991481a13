#include "retarget/baselines/body_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Weights of 40 vertices near a joint that sum to 1 and meet in it, of least size.
void regress(const ShapedBody& person, int joint, RowMatrix& regressor) {
  std::vector<int> order(static_cast<size_t>(person.vertices.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto far = [&](int v) { return (person.vertices.row(v) - person.joints.row(joint)).squaredNorm(); };
  std::partial_sort(order.begin(), order.begin() + 40, order.end(),
                    [&](int a, int b) { return far(a) < far(b); });
  Eigen::Matrix<double, 4, 40> A;
  for (int i = 0; i < 40; ++i) {
    const Vec3 v = person.vertices.row(order[static_cast<size_t>(i)]);
    A.col(i) << v.cast<double>(), 1;
  }
  Eigen::Vector4d b;
  b << Vec3(person.joints.row(joint)).cast<double>(), 1;
  const Eigen::Matrix<double, 40, 1> x = A.transpose() * (A * A.transpose()).ldlt().solve(b);
  for (int i = 0; i < 40; ++i) regressor(joint, order[static_cast<size_t>(i)]) = static_cast<float>(x[i]);
}

/// The built-in person as a body whose one shape parameter is size, 5 % a unit.
Body parametric(const ShapedBody& person) {
  Body body;
  body.template_vertices = person.vertices;
  body.faces = person.faces;
  body.weights = person.weights;
  body.shape_dirs = 0.05f * Eigen::Map<const Eigen::VectorXf>(person.vertices.data(), person.vertices.size());
  body.joint_regressor = RowMatrix::Zero(kJointCount, person.vertices.rows());
  for (int j = 0; j < kJointCount; ++j) regress(person, j, body.joint_regressor);
  return body;
}

class Fit : public testing::Test {
 protected:
  Fit() : body(parametric(builtin_person())), fit_body(std::make_shared<FitBody>(body, 500)) {
    options.scan_points = 300;
    options.start_iterations = 6;
    options.first_iterations = 25;
    options.iterations = 10;
  }
  Mesh scan(const ShapedBody& person, const Pose& pose, uint64_t seed) const {
    Rng rng(seed);
    return {sample_points({posed_vertices(person, pose), person.faces, {}}, 2000, rng), Faces(0, 3),
            Points(0, 3)};
  }
  Body body;
  std::shared_ptr<const FitBody> fit_body;
  BodyFitOptions options;
};

TEST_F(Fit, FollowsAWalkerOfAnotherSizeFromAnyHeading) {
  const ShapedBody person = body.shaped(Eigen::VectorXf::Constant(1, -1.5f));
  const Motion walk = builtin_motion("walk", person.joints);
  BodyFit fit(fit_body, options);
  for (int t = 0; t < 4; ++t) {
    Pose pose = walk.poses[static_cast<size_t>(t)];
    pose.local[Pelvis] = rotation_about_y(2) * pose.local[Pelvis];
    pose.root = rotation_about_y(2) * pose.root + Vec3(1, 0.2f, 0);
    const Extraction seen = fit.extract(scan(person, pose, static_cast<uint64_t>(t)));
    const Joints truth = forward_kinematics(person.joints, pose).joints;
    EXPECT_LT((seen.joints - truth).rowwise().norm().mean(), 0.03f) << "frame " << t;
    ASSERT_TRUE(seen.exact && seen.global);
    EXPECT_LT(geodesic_angle((*seen.global)[Pelvis], pose.local[Pelvis]), 0.3f);
  }
}

TEST_F(Fit, RefusesAScanOfAlmostNothing) {
  BodyFit fit(fit_body, options);
  EXPECT_THROW(fit.extract({Points::Zero(20, 3), Faces(0, 3), Points(0, 3)}), Error);
}

}  // namespace
}  // namespace understudy
