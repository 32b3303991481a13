#include "retarget/skeleton/leg_ik.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kSoft = 0.012f;       // share of the leg's length in which it straightens softly
constexpr float kStraight = 0.9995f;  // share of its length that it is never straighter than

/// How far the ankle may go from the hip: as wanted when the leg is bent or gets no longer than it was.
float softened(float wanted, float now, float length) {
  const float longest = std::max(now, kStraight * length);
  const float start = std::max(now, (1 - kSoft) * length);
  if (wanted <= start || longest - start < 1e-6f * length) return std::min(wanted, longest);
  return longest - (longest - start) * std::exp(-(wanted - start) / (longest - start));
}

/// The knee's axis in the world: of its bend against the T-pose, and near that pose x, about which knees
/// bend.
Vec3 knee_axis(const Joints& rest, const Leg& leg, const Pose& pose, const PosedSkeleton& posed) {
  constexpr float kSure = 0.15f;  // radians of bend that outweigh the T-pose's axis
  const Vec3 shin = (rest.row(leg.ankle) - rest.row(leg.knee)).transpose().normalized();
  const Vec3 bent = pose.local[static_cast<size_t>(leg.knee)] * shin;
  const Vec3 c = shin.cross(bent);  // leaves out the twist about the shin
  const float angle = std::atan2(c.norm(), shin.dot(bent));
  const Vec3 bend = c.norm() > 1e-6f ? Vec3(c.normalized() * angle) : Vec3(Vec3::Zero());
  const Vec3 axis = bend + kSure * Vec3::UnitX();
  return (posed.global[static_cast<size_t>(leg.hip)] * (axis.norm() > 1e-3f ? axis : bend)).normalized();
}

}  // namespace

Vec3 place_ankle(const Joints& rest, int side, const Vec3& ankle, Pose& pose) {
  const Leg leg = Leg::of(side);
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  const Vec3 hip = posed.joints.row(leg.hip).transpose();
  const Vec3 u = posed.joints.row(leg.knee).transpose() - hip;                            // thigh
  const Vec3 s = (posed.joints.row(leg.ankle) - posed.joints.row(leg.knee)).transpose();  // shin
  const Vec3 reached = hip + u + s;
  if ((ankle - reached).squaredNorm() < 1e-14f) return reached;
  const float length = u.norm() + s.norm(), now = (u + s).norm();
  const float shortest = std::abs(u.norm() - s.norm()) + 0.05f * length;
  const float d = softened(std::max((ankle - hip).norm(), std::min(shortest, now)), now, length);

  const Vec3 n = knee_axis(rest, leg, pose, posed);
  // |u + Rot(n, phi) s| = d, that is P cos(phi) + Q sin(phi) = r.
  const float un = u.dot(n), sn = s.dot(n);
  const float P = u.dot(s) - un * sn, Q = u.dot(n.cross(s));
  const float r = 0.5f * (d * d - u.squaredNorm() - s.squaredNorm()) - un * sn;
  const float straight = std::atan2(Q, P);
  const float phi = straight + std::acos(std::clamp(r / std::hypot(P, Q), -1.0f, 1.0f));
  const Mat3 bend = Eigen::AngleAxisf(phi, n).toRotationMatrix();

  const Vec3 to = ankle - hip, bent = u + bend * s;
  const Mat3 aim = to.norm() > 1e-6f ? rotation_between(bent, to) : Mat3(Mat3::Identity());
  Rotations global = posed.global;
  global[static_cast<size_t>(leg.hip)] = aim * global[static_cast<size_t>(leg.hip)];
  global[static_cast<size_t>(leg.knee)] = aim * bend * global[static_cast<size_t>(leg.knee)];
  const int pelvis = kParents[static_cast<size_t>(leg.hip)];
  const auto set_local = [&](int j, int parent) {
    pose.local[static_cast<size_t>(j)] =
        global[static_cast<size_t>(parent)].transpose() * global[static_cast<size_t>(j)];
  };
  set_local(leg.hip, pelvis);
  set_local(leg.knee, leg.hip);
  set_local(leg.ankle, leg.knee);  // its world rotation stays
  return hip + aim * bent;
}

}  // namespace understudy
