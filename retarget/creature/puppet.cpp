#include "retarget/creature/puppet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Vec2 = Eigen::Vector2f;

float angle_of(const Vec2& v) {
  return std::atan2(v.y(), v.x());
}

Mat3 about(const Vec3& axis, float angle) {
  return Eigen::AngleAxisf(angle, axis).toRotationMatrix();
}

/// Columns: towards `to`, beside it in the limb's plane, the plane's normal (as near to `normal` as can be).
Mat3 plane_frame(const Vec3& to, const Vec3& normal) {
  const Vec3 along = to.normalized();
  const Vec3 n = (normal - along * along.dot(normal)).normalized();
  Mat3 frame;
  frame << along, n.cross(along), n;
  return frame;
}

/// Directions, in radians, of two segments that lead to `at`; they bend to the given side (1 or -1).
std::array<float, 2> two_segments(float first, float second, const Vec2& at, float side) {
  const float most = 0.9995f * (first + second), least = 1.0005f * std::abs(first - second) + 1e-6f;
  const float reach = std::clamp(at.norm(), least, most);
  const Vec2 end = at.normalized() * reach;
  const float cosine = (first * first + reach * reach - second * second) / (2 * first * reach);
  const float start = angle_of(end) + side * std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const Vec2 knee = first * Vec2(std::cos(start), std::sin(start));
  return {start, angle_of(end - knee)};
}

int joint_named(const Rig& rig, const std::string& name) {
  const int j = bone_named(rig, name);
  US_CHECK(j >= 0, rig.name, " has no joint '", name, "'");
  return j;
}

Vec3 lowest_of(const Rig& rig, int bone) {
  Vec3 lowest = Vec3::Constant(1e9f);
  for (Eigen::Index v = 0; v < rig.surface.vertices.rows(); ++v)
    if (rig.skin.bones(v, 0) == bone && rig.surface.vertices(v, 1) < lowest.y())
      lowest = rig.surface.vertices.row(v).transpose();
  US_CHECK(lowest.y() < 1e8f, rig.name, ": nothing hangs on joint ", bone);
  return lowest;
}

}  // namespace

float wave(float seconds, float period, float phase) {
  return std::sin(2 * kPi * (seconds / period + phase));
}

float visiting(float seconds, float period, const std::vector<float>& values) {
  const auto count = static_cast<int>(values.size());
  const float at = (seconds / period - std::floor(seconds / period)) * static_cast<float>(count);
  const int from = std::min(static_cast<int>(at), count - 1);
  const float way = at - static_cast<float>(from), eased = 0.5f - 0.5f * std::cos(kPi * way);
  const float a = values[static_cast<size_t>(from)], b = values[static_cast<size_t>((from + 1) % count)];
  return a + eased * (b - a);
}

int Puppet::joint(const std::string& name) const {
  return joint_named(rig_, name);
}

void Puppet::turn(const std::string& name, const Vec3& axis, float angle) {
  Mat3& R = pose.turns[static_cast<size_t>(joint(name))];
  R = R * about(axis.normalized(), angle);
}

void Puppet::turn(const std::string& name, float angle) {
  turn(name, rig_.joints[static_cast<size_t>(joint(name))].axis, angle);
}

void Puppet::slide(const std::string& name, float metres) {
  pose.slides[static_cast<size_t>(joint(name))] = metres;
}

RigidMotion Puppet::bone(int at) const {
  const auto j = static_cast<size_t>(at);
  const RigJoint& joint = rig_.joints[j];
  if (joint.parent < 0) return {pose.turns[j], pose.root - pose.turns[j] * joint.rest};
  const RigidMotion parent = bone(joint.parent);
  const Mat3 R = parent.R * pose.turns[j];
  const Vec3 place = parent(joint.rest) + pose.slides[j] * (parent.R * joint.axis);
  return {R, place - R * joint.rest};
}

void Puppet::reach(const Limb& limb, const Vec3& target, float pitch) {
  const auto& joints = rig_.joints;
  const auto first = static_cast<size_t>(limb.joints[0]);
  const RigidMotion trunk = bone(joints[first].parent);
  const Vec3 hip = trunk(joints[first].rest), normal = joints[static_cast<size_t>(limb.joints[1])].axis;
  const Mat3 rest = plane_frame(limb.end - joints[first].rest, normal);
  const Mat3 now = plane_frame(target - hip, trunk.R * normal);

  std::vector<Vec2> bones;  // at rest, in the limb's plane
  for (size_t i = 0; i < limb.joints.size(); ++i) {
    const Vec3 from = joints[static_cast<size_t>(limb.joints[i])].rest;
    const bool last = i + 1 == limb.joints.size();
    const Vec3 to = last ? limb.end : joints[static_cast<size_t>(limb.joints[i + 1])].rest;
    bones.push_back((rest.transpose() * (to - from)).head<2>());
  }
  Vec2 at((target - hip).norm(), 0), rest_at = bones[0] + bones[1];
  std::vector<float> angles(bones.size());
  if (bones.size() == 3) {  // the last one is told where to point, the other two reach for its beginning
    const Vec3 carried = trunk.R * rest.leftCols<2>() * bones[2];
    const Vec2 wanted = (now.transpose() * carried).head<2>();
    angles[2] = angle_of(wanted) + pitch;
    at -= bones[2].norm() * Vec2(std::cos(angles[2]), std::sin(angles[2]));
  }
  const float side = rest_at.x() * bones[0].y() - rest_at.y() * bones[0].x() > 0 ? 1.0f : -1.0f;
  const auto two = two_segments(bones[0].norm(), bones[1].norm(), at, side);
  angles[0] = two[0];
  angles[1] = two[1];

  float before = angles[0] - angle_of(bones[0]);
  const Mat3 R = now * about(Vec3::UnitZ(), before) * rest.transpose();
  pose.turns[first] = trunk.R.transpose() * R;
  for (size_t i = 1; i < bones.size(); ++i) {
    const float turned = angles[i] - angle_of(bones[i]);
    pose.turns[static_cast<size_t>(limb.joints[i])] = about(normal, turned - before);
    before = turned;
  }
}

void Puppet::plant(const Limb& limb, const Vec3& place, const Mat3& facing, float pitch) {
  reach(limb, place + facing * (limb.end - limb.contact), pitch);
  if (limb.paw >= 0)
    pose.turns[static_cast<size_t>(limb.paw)] = bone(limb.joints.back()).R.transpose() * facing;
}

Limb limb_of(const Rig& rig, const std::vector<std::string>& joints, const std::string& paw) {
  Limb limb;
  for (const std::string& name : joints) limb.joints.push_back(joint_named(rig, name));
  if (!paw.empty()) limb.paw = joint_named(rig, paw);
  limb.contact = lowest_of(rig, paw.empty() ? limb.joints.back() : limb.paw);
  const Vec3 hip = rig.joints[static_cast<size_t>(limb.joints[0])].rest;
  const Vec3 normal = rig.joints[static_cast<size_t>(limb.joints[1])].axis;
  const Vec3 end = paw.empty() ? limb.contact : rig.joints[static_cast<size_t>(limb.paw)].rest;
  limb.end = end - normal * normal.dot(end - hip);
  if (paw.empty()) limb.contact = limb.end;
  return limb;
}

float size_of(const Rig& rig) {
  return (rig.surface.vertices.colwise().maxCoeff() - rig.surface.vertices.colwise().minCoeff()).maxCoeff();
}

}  // namespace understudy
