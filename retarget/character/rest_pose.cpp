#include "retarget/character/rest_pose.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {

Vec3 bone(const Joints& joints, int from, int to) {
  return (joints.row(to) - joints.row(from)).transpose();
}

namespace {

float angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// R, turned by the least that brings R * along to `wanted`, where they are further apart than the tolerance.
Mat3 brought(const Mat3& R, const Vec3& along, const Vec3& wanted, float tolerance) {
  if (along.norm() < 1e-6f || angle_between(R * along, wanted) <= tolerance) return R;
  return rotation_between(R * along, wanted) * R;
}

/// Joints of the T-pose from those of the bind pose and the turns.
void place_rest(RestPose& pose) {
  pose.rest.row(Pelvis) = pose.bind.row(Pelvis);
  pose.largest_deg = 0;
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    const Mat3& Q = pose.to_rest[j];
    pose.largest_deg = std::max(pose.largest_deg, geodesic_angle(Mat3::Identity(), Q) * 180 / kPi);
    if (p >= 0) pose.rest.row(j) = pose.rest.row(p) + (pose.to_rest[p] * bone(pose.bind, p, j)).transpose();
  }
}

}  // namespace

Pose RestPose::back() const {
  Rotations global;
  for (size_t j = 0; j < kJointCount; ++j) global[j] = to_rest[j].transpose();
  Pose pose;
  pose.local = local_rotations(global);
  pose.root = bind.row(Pelvis).transpose();
  return pose;
}

RestPose to_t_pose(const Joints& bind, float tolerance_deg) {
  US_CHECK(bind.allFinite(), "a joint of the character is not finite");
  RestPose out;
  out.bind = bind;
  Rotations& Q = out.to_rest;
  const Joints& human = human_rest();
  const float tolerance = tolerance_deg * kPi / 180;
  for (const int right : {0, 1}) {
    const Vec3 sideways = right == 1 ? Vec3(-1, 0, 0) : Vec3(1, 0, 0);
    const int shoulder = LeftShoulder + right, elbow = shoulder + 2, wrist = elbow + 2;
    const int hip = LeftHip + right, knee = hip + 3, ankle = knee + 3;
    Q[shoulder] = brought(Mat3::Identity(), bone(bind, shoulder, elbow), sideways, tolerance);
    Q[elbow] = brought(Q[shoulder], bone(bind, elbow, wrist), sideways, tolerance);
    Q[wrist] = Q[elbow];
    Q[hip] = brought(Mat3::Identity(), bone(bind, hip, knee), bone(human, hip, knee), tolerance);
    Q[knee] = brought(Q[hip], bone(bind, knee, ankle), bone(human, knee, ankle), tolerance);
  }
  place_rest(out);
  return out;
}

void spread_legs(RestPose& pose, float tolerance_deg) {
  const auto outward = [](const Joints& joints) {
    const Vec3 left = bone(joints, LeftHip, LeftAnkle), right = bone(joints, RightHip, RightAnkle);
    return 0.5f * (std::atan2(left.x(), -left.y()) - std::atan2(right.x(), -right.y()));
  };
  const float turn = outward(human_rest()) - outward(pose.rest);
  if (std::abs(turn) * 180 / kPi <= tolerance_deg) return;
  for (const int right : {0, 1}) {
    const Mat3 R = Eigen::AngleAxisf(right == 1 ? -turn : turn, Vec3::UnitZ()).toRotationMatrix();
    for (const int j : {LeftHip + right, LeftKnee + right}) pose.to_rest[j] = R * pose.to_rest[j];
  }
  place_rest(pose);
}

RestPose with_joints(RestPose pose, const Joints& bind) {
  pose.bind = bind;
  place_rest(pose);
  return pose;
}

Points in_t_pose(const Points& vertices, const RowMatrix& weights, const RestPose& pose) {
  return linear_blend_skinning(vertices, weights, pose.bind, {pose.to_rest, pose.rest});
}

float heading_of_joints(const Joints& joints) {
  const Vec3 left =
      bone(joints, RightHip, LeftHip).normalized() + bone(joints, RightShoulder, LeftShoulder).normalized();
  return std::atan2(-left.z(), left.x());
}

}  // namespace understudy
