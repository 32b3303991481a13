#include "retarget/math/rotation.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {

Mat3 rotation_from_6d(const Vec6& r) {
  const Vec3 a1 = r.head<3>(), a2 = r.tail<3>();
  const Vec3 b1 = a1.normalized();
  const Vec3 u2 = a2 - b1.dot(a2) * b1;  // a2 minus its b1 part
  US_CHECK(a1.norm() > 1e-8f && u2.norm() > 1e-8f, "6D rotation has zero or parallel columns");
  const Vec3 b2 = u2.normalized();

  Mat3 R;
  R << b1, b2, b1.cross(b2);
  return R;
}

Vec6 rotation_to_6d(const Mat3& R) {
  Vec6 r;
  r << R.col(0), R.col(1);
  return r;
}

Mat3 rotation_from_axis_angle(const Vec3& axis_angle) {
  const float angle = axis_angle.norm();
  if (angle < 1e-8f) return Mat3::Identity();
  return Eigen::AngleAxisf(angle, axis_angle / angle).toRotationMatrix();
}

Vec3 rotation_to_axis_angle(const Mat3& R) {
  const Eigen::AngleAxisf aa(R);
  return aa.angle() * aa.axis();
}

Mat3 rotation_about_y(float angle) {
  return Eigen::AngleAxisf(angle, Vec3::UnitY()).toRotationMatrix();
}

float heading_of(const Mat3& R) {
  return std::atan2(R(0, 2), R(2, 2));
}

Mat3 rotation_between(const Vec3& from, const Vec3& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to).toRotationMatrix();
}

float geodesic_angle(const Mat3& A, const Mat3& B) {
  // atan2 keeps its precision near 0 and pi, where acos of the trace loses it.
  const Mat3 R = A.transpose() * B;
  const Vec3 sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(sine.norm(), R.trace() - 1.0f);
}

Mat3 nearest_quarter_turn(const Mat3& R) {
  Mat3 out = Mat3::Zero();
  for (int c = 0; c < 3; ++c) {
    Eigen::Index row = 0;
    R.col(c).cwiseAbs().maxCoeff(&row);
    out(row, c) = R(row, c) > 0 ? 1.0f : -1.0f;
  }
  const bool is_rotation =
      std::abs(out.determinant() - 1.0f) < 1e-3f && (out * out.transpose()).isIdentity(1e-3f);
  return is_rotation ? out : R;
}

Mat3 nearest_rotation(const Mat3& M) {
  const Eigen::JacobiSVD<Mat3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0f : 1.0f);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

Mat3 kabsch(const Points& a, const Points& b, const Eigen::VectorXf& w) {
  US_CHECK(a.rows() == b.rows() && a.rows() == w.size(), "kabsch: ", a.rows(), ", ", b.rows(), " points and ",
           w.size(), " weights");
  const Mat3 covariance = b.transpose() * w.asDiagonal() * a;  // sum_i w_i b_i a_i^T
  return nearest_rotation(covariance);
}

Points Similarity::apply(const Points& points) const {
  return ((scale * points * R.transpose()).rowwise() + t.transpose()).eval();
}

}  // namespace understudy
