#include "retarget/skeleton/skinning.hpp"

#include "retarget/base/error.hpp"

namespace understudy {

JointTransforms joint_transforms(const Joints& rest_joints, const PosedSkeleton& posed) {
  JointTransforms transforms;
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3& R = posed.global[j];
    const Vec3 t = posed.joints.row(j).transpose() - R * rest_joints.row(j).transpose();
    for (int r = 0; r < 3; ++r) transforms.block<1, 3>(j, 3 * r) = R.row(r);
    transforms.block<1, 3>(j, 9) = t.transpose();
  }
  return transforms;
}

Points linear_blend_skinning(const Points& rest, const RowMatrix& weights, const Joints& rest_joints,
                             const PosedSkeleton& posed) {
  US_CHECK(rest.rows() == weights.rows() && weights.cols() == kJointCount, "skinning: ", rest.rows(),
           " vertices but weights of ", weights.rows(), "x", weights.cols());
  const RowMatrix blended = weights * joint_transforms(rest_joints, posed);  // [V, 12]
  Points vertices(rest.rows(), 3);
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
    for (int r = 0; r < 3; ++r)
      vertices(v, r) = blended.block<1, 3>(v, 3 * r).dot(rest.row(v)) + blended(v, 9 + r);
  return vertices;
}

}  // namespace understudy
