#include "retarget/creature/solid_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

using Vec2 = Eigen::Vector2f;

/// Of a ball that rolls along the axis from 0 to `length` while its radius changes. at: beside, along.
float rolling_ball(const Vec2& at, const SolidPart& part) {
  const float slope = std::clamp((part.from - part.to) / std::max(part.length, 1e-6f), -0.95f, 0.95f);
  const float side = std::sqrt(1 - slope * slope);
  const float along = side * at.y() - slope * at.x();
  if (along < 0) return at.norm() - part.from;
  if (along > side * part.length) return (at - Vec2(0, part.length)).norm() - part.to;
  return side * at.x() + slope * at.y() - part.from;
}

float outside_both(float a, float b) {
  return std::min(std::max(a, b), 0.0f) + std::hypot(std::max(a, 0.0f), std::max(b, 0.0f));
}

float frustum_distance(const Vec3& q, const SolidPart& part) {
  const float radius = part.from + (part.to - part.from) * q.z() / part.length;
  const float tilt = part.length / std::hypot(part.length, part.to - part.from);
  const float beside = (std::hypot(q.x(), q.y()) - radius) * tilt;
  return outside_both(beside, std::abs(q.z() - 0.5f * part.length) - 0.5f * part.length);
}

float ellipsoid_distance(const Vec3& q, const Vec3& radii) {
  const float scaled = q.cwiseQuotient(radii).norm();
  const float steep = q.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return steep < 1e-6f ? -radii.minCoeff() : scaled * (scaled - 1) / steep;
}

SolidPart lengthwise(SolidPart::Shape shape, const Vec3& a, const Vec3& b, const Vec3& x) {
  SolidPart part;
  part.shape = shape;
  part.origin = a;
  part.length = (b - a).norm();
  part.axes = frame_along(b - a, x).transpose();
  return part;
}

}  // namespace

Mat3 frame_along(const Vec3& z, const Vec3& x) {
  const Vec3 along = z.normalized();
  Vec3 beside = x - along * along.dot(x);
  beside = beside.norm() < 1e-4f * x.norm() ? along.unitOrthogonal() : Vec3(beside.normalized());
  Mat3 frame;
  frame << beside, along.cross(beside), along;
  return frame;
}

SolidPart cone_part(const Vec3& a, float from, const Vec3& b, float to) {
  SolidPart part = lengthwise(SolidPart::Shape::Cone, a, b, Vec3::UnitX());
  part.from = from;
  part.to = to;
  part.thickness = std::min(from, to);
  part.blend = 0.4f * part.thickness;
  return part;
}

SolidPart ellipsoid_part(const Vec3& centre, const Vec3& radii, const Mat3& frame) {
  SolidPart part;
  part.origin = centre;
  part.axes = frame.transpose();
  part.half = radii;
  part.thickness = radii.minCoeff();
  part.blend = 0.4f * part.thickness;
  return part;
}

SolidPart box_part(const Vec3& centre, const Vec3& half, float round, const Mat3& frame) {
  SolidPart part = ellipsoid_part(centre, half - Vec3::Constant(round), frame);
  part.shape = SolidPart::Shape::Box;
  part.round = round;
  part.thickness = half.minCoeff();
  part.blend = 0.2f * part.thickness;
  return part;
}

SolidPart frustum_part(const Vec3& a, float from, const Vec3& b, float to, float round) {
  const Vec3 inward = (b - a).normalized() * round;
  SolidPart part = lengthwise(SolidPart::Shape::Frustum, a + inward, b - inward, Vec3::UnitX());
  part.from = from - round;
  part.to = to - round;
  part.round = round;
  part.thickness = std::min({from, to, 0.5f * (b - a).norm()});
  part.blend = 0.2f * part.thickness;
  return part;
}

SolidPart blade_part(const Vec3& a, float from, const Vec3& b, float to, const BladeShape& shape) {
  SolidPart part = lengthwise(SolidPart::Shape::Blade, a, b, shape.normal);
  part.round = shape.round >= 0 ? shape.round : 0.9f * std::min({shape.half_thick, from, to});
  part.from = from - part.round;
  part.to = to - part.round;
  part.half.x() = shape.half_thick - part.round;
  part.thickness = shape.half_thick;
  part.blend = 0.4f * part.thickness;
  return part;
}

float distance_to(const SolidPart& part, const Vec3& p) {
  const Vec3 q = part.axes * (p - part.origin);
  switch (part.shape) {
    case SolidPart::Shape::Cone:
      return rolling_ball({std::hypot(q.x(), q.y()), q.z()}, part);
    case SolidPart::Shape::Ellipsoid:
      return ellipsoid_distance(q, part.half);
    case SolidPart::Shape::Box: {
      const Vec3 out = q.cwiseAbs() - part.half;
      return out.cwiseMax(0.0f).norm() + std::min(out.maxCoeff(), 0.0f) - part.round;
    }
    case SolidPart::Shape::Frustum:
      return frustum_distance(q, part) - part.round;
    case SolidPart::Shape::Blade:
      break;
  }
  const float in_plane = rolling_ball({std::abs(q.y()), q.z()}, part);
  return outside_both(in_plane, std::abs(q.x()) - part.half.x()) - part.round;
}

float beyond_ends(const SolidPart& part, const Vec3& p) {
  if (part.shape == SolidPart::Shape::Ellipsoid || part.shape == SolidPart::Shape::Box) return 0;
  const float along = part.axes.row(2).dot(p - part.origin);
  return std::max({0.0f, -along, along - part.length});
}

float smooth_minimum(float a, float b, float blend) {
  const float near = std::max(blend - std::abs(a - b), 0.0f);
  return std::min(a, b) - (blend > 0 ? 0.25f * near * near / blend : 0.0f);
}

}  // namespace understudy
