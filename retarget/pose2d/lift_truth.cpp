#include "retarget/pose2d/lift_truth.hpp"

#include "retarget/math/rotation.hpp"

namespace understudy {

Vec3 hips_middle(const Joints& joints) {
  return (joints.row(LeftHip) + joints.row(RightHip)).transpose() / 2;
}

Mat3 turn_from_middle(const Vec3& way) {
  return rotation_between(Vec3::UnitZ(), way);
}

LiftTruth lift_truth(const PosedSkeleton& posed, const Pinhole& camera) {
  const Vec3 middle = hips_middle(posed.joints);
  const Vec3 to_eye = camera.rotation.transpose() * (camera.position - middle);
  const Mat3 turn = camera.orthographic ? Mat3(Mat3::Identity()) : turn_from_middle(to_eye);
  const Mat3 axes = camera.rotation * turn;  // as columns in the world
  LiftTruth truth;
  truth.joints = (posed.joints.rowwise() - middle.transpose()) * axes;
  for (size_t j = 0; j < truth.turns.size(); ++j) truth.turns[j] = axes.transpose() * posed.global[j];
  truth.pixels_a_metre = camera.pixels_a_metre(to_eye.z());
  return truth;
}

}  // namespace understudy
