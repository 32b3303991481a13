#include "retarget/skeleton/limb_ik.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kSoft = 0.012f;       // share of the limb's length in which it straightens softly
constexpr float kStraight = 0.9995f;  // share of its length that it is never straighter than

struct TwoBones {
  int upper, hinge, end;  // joints, parent first
  Vec3 axis;              // about which the hinge bends near the T-pose, in T-pose axes
};

/// How far the end may go from the upper joint: as wanted when the limb is bent or gets no longer than it
/// was.
float softened(float wanted, float now, float length) {
  const float longest = std::max(now, kStraight * length);
  const float start = std::max(now, (1 - kSoft) * length);
  if (wanted <= start || longest - start < 1e-6f * length) return std::min(wanted, longest);
  return longest - (longest - start) * std::exp(-(wanted - start) / (longest - start));
}

/// The hinge's axis in the world: of its bend against the T-pose, and near that pose the limb's usual one.
Vec3 hinge_axis(const Joints& rest, const TwoBones& limb, const Pose& pose, const PosedSkeleton& posed) {
  constexpr float kSure = 0.15f;  // radians of bend that outweigh the T-pose's axis
  const Vec3 lower = (rest.row(limb.end) - rest.row(limb.hinge)).transpose().normalized();
  const Vec3 bent = pose.local[limb.hinge] * lower;
  const Vec3 c = lower.cross(bent);  // leaves out the twist about the lower bone
  const float angle = std::atan2(c.norm(), lower.dot(bent));
  const Vec3 bend = c.norm() > 1e-6f ? Vec3(c.normalized() * angle) : Vec3(Vec3::Zero());
  const Vec3 axis = bend + kSure * limb.axis;
  return (posed.global[limb.upper] * (axis.norm() > 1e-3f ? axis : bend)).normalized();
}

/// What legs and arms share; see place_ankle.
Vec3 place_end(const Joints& rest, const TwoBones& limb, const Vec3& wanted, Pose& pose) {
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  const Vec3 top = posed.joints.row(limb.upper).transpose();
  const Vec3 u = posed.joints.row(limb.hinge).transpose() - top;                           // upper bone
  const Vec3 s = (posed.joints.row(limb.end) - posed.joints.row(limb.hinge)).transpose();  // lower bone
  Vec3 reached = top + u + s;
  if ((wanted - reached).squaredNorm() < 1e-14f) return reached;
  const float length = u.norm() + s.norm(), now = (u + s).norm();
  const float shortest = std::abs(u.norm() - s.norm()) + 0.05f * length;
  const float d = softened(std::max((wanted - top).norm(), std::min(shortest, now)), now, length);

  const Vec3 n = hinge_axis(rest, limb, pose, posed);
  // |u + Rot(n, phi) s| = d, that is P cos(phi) + Q sin(phi) = r.
  const float un = u.dot(n), sn = s.dot(n);
  const float P = u.dot(s) - un * sn, Q = u.dot(n.cross(s));
  const float r = 0.5f * (d * d - u.squaredNorm() - s.squaredNorm()) - un * sn;
  const float straight = std::atan2(Q, P);
  const float phi = straight + std::acos(std::clamp(r / std::hypot(P, Q), -1.0f, 1.0f));
  const Mat3 bend = Eigen::AngleAxisf(phi, n).toRotationMatrix();

  const Vec3 to = wanted - top, bent = u + bend * s;
  const Mat3 aim = to.norm() > 1e-6f ? rotation_between(bent, to) : Mat3(Mat3::Identity());
  Rotations global = posed.global;
  global[limb.upper] = aim * global[limb.upper];
  global[limb.hinge] = aim * bend * global[limb.hinge];
  const int above = kParents[limb.upper];
  const auto set_local = [&](int j, int parent) { pose.local[j] = global[parent].transpose() * global[j]; };
  set_local(limb.upper, above);
  set_local(limb.hinge, limb.upper);
  set_local(limb.end, limb.hinge);  // its world rotation stays
  return top + aim * bent;
}

}  // namespace

Vec3 place_ankle(const Joints& rest, int side, const Vec3& ankle, Pose& pose) {
  const Leg leg = Leg::of(side);
  return place_end(rest, {leg.hip, leg.knee, leg.ankle, Vec3::UnitX()}, ankle, pose);
}

Vec3 place_wrist(const Joints& rest, int side, const Vec3& wrist, Pose& pose) {
  const float sign = side == 0 ? 1.0f : -1.0f;  // elbows flex the forearm forward and a little up
  const TwoBones arm{LeftShoulder + side, LeftElbow + side, LeftWrist + side, sign * Vec3(0, -0.87f, 0.49f)};
  return place_end(rest, arm, wrist, pose);
}

}  // namespace understudy
