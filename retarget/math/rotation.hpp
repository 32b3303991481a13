// Rotations: 6D form, axis-angle, quaternions, angles, and the best rotation between point sets.
#pragma once

#include <Eigen/Geometry>

#include "retarget/math/types.hpp"

namespace understudy {

/// Rotation from its 6D form (first two columns, not necessarily orthonormal), by Gram-Schmidt.
/// Continuous in `r`, which is why the networks predict it (Zhou et al., CVPR 2019, eq. 15).
/// Throws Error when the two columns are zero or parallel.
Mat3 rotation_from_6d(const Vec6& r);
/// The first two columns of R, one after the other.
Vec6 rotation_to_6d(const Mat3& R);

/// Rodrigues' formula; the length of `axis_angle` is the angle in radians.
Mat3 rotation_from_axis_angle(const Vec3& axis_angle);
/// Inverse of the above, angle in [0, pi].
Vec3 rotation_to_axis_angle(const Mat3& R);
/// Rotation about +y by `angle` radians: takes +z towards +x.
Mat3 rotation_about_y(float angle);
/// How far a body turned so faces away from +z, radians about +y: where R takes +z, seen from above.
float heading_of(const Mat3& R);
/// The smallest rotation that takes direction `from` to direction `to` (any lengths but zero).
Mat3 rotation_between(const Vec3& from, const Vec3& to);
/// Angle of A^T B in radians, [0, pi].
float geodesic_angle(const Mat3& A, const Mat3& B);
/// The nearest turn by quarters; R itself where its columns agree on none. A rest pose may lean and look
/// aside, but a bind pose is modelled along the axes.
Mat3 nearest_quarter_turn(const Mat3& R);
/// The nearest rotation to any 3x3 matrix in the Frobenius norm, by SVD.
Mat3 nearest_rotation(const Mat3& M);
/// R minimising sum_i w_i |R a_i - b_i|^2 over rotations (Kabsch). a, b [N, 3] already centred; w [N].
Mat3 kabsch(const Points& a, const Points& b, const Eigen::VectorXf& w);

/// x -> scale * R x + t.
struct Similarity {
  float scale = 1;
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();
  Points apply(const Points& points) const;
};

}  // namespace understudy
