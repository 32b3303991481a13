// A person made by code with a hand somewhere.
#pragma once

#include <Eigen/Geometry>

#include "retarget/body/builtin_person.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy::fixtures {

/// The skin in front of the spine, `height` metres over the pelvis joint, of a person in T-pose.
inline Vec3 front_of(const ShapedBody& body, float height) {
  Vec3 front(0, height, -1);
  for (Eigen::Index v = 0; v < body.vertices.rows(); ++v)
    if (std::abs(body.vertices(v, 0)) < 0.05f && std::abs(body.vertices(v, 1) - height) < 0.02f)
      front.z() = std::max(front.z(), body.vertices(v, 2));
  return front;
}

/// Bends an arm (0 left, 1 right) so that the middle of its hand comes to `place`, the hand across the body,
/// its palm to it; gives back where its wrist came. The pose must be the T-pose but for other arms.
inline Vec3 place_hand(const ShapedBody& body, int side, const Vec3& place, Pose& pose) {
  const float sign = side == 0 ? 1.0f : -1.0f;
  const auto elbow = static_cast<size_t>(LeftElbow + side),
             shoulder = static_cast<size_t>(LeftShoulder + side),
             wrist = static_cast<size_t>(LeftWrist + side);
  const Vec3 forearm = (body.joints.row(LeftWrist + side) - body.joints.row(LeftElbow + side)).transpose();
  pose.local[shoulder] = Eigen::AngleAxisf(-1.0f * sign, Vec3::UnitZ()).toRotationMatrix();
  pose.local[elbow] = Eigen::AngleAxisf(-1.6f * sign, Vec3(0, 0.87f, -0.49f).normalized()).toRotationMatrix();
  // The hand points to the other side.
  const Mat3 hand =
      (Eigen::AngleAxisf(kPi * sign, Vec3::UnitY()) * Eigen::AngleAxisf(-0.5f * kPi, Vec3::UnitX()))
          .toRotationMatrix();
  const auto turn_hand = [&] {
    pose.local[wrist] = forward_kinematics(body.joints, pose).global[elbow].transpose() * hand;
  };
  turn_hand();
  const Vec3 middle = hand * (0.4f * forearm);
  const Vec3 came = place_wrist(body.joints, side, place - middle, pose);
  // The elbow swings out to the side, away from the body.
  const PosedSkeleton posed = forward_kinematics(body.joints, pose);
  const Vec3 top = posed.joints.row(LeftShoulder + side).transpose(), axis = (came - top).normalized();
  const Vec3 bent = posed.joints.row(LeftElbow + side).transpose() - top, out(sign, 0, 0);
  const Vec3 from = bent - bent.dot(axis) * axis, to = out - out.dot(axis) * axis;
  const float angle = std::atan2(axis.dot(from.cross(to)), from.dot(to));
  const Mat3 above = posed.global[shoulder] * pose.local[shoulder].transpose();
  pose.local[shoulder] =
      above.transpose() * Eigen::AngleAxisf(angle, axis).toRotationMatrix() * posed.global[shoulder];
  turn_hand();
  return came;
}

}  // namespace understudy::fixtures
