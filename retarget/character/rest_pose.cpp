#include "retarget/character/rest_pose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

Vec3 bone(const Joints& joints, int from, int to) {
  return (joints.row(to) - joints.row(from)).transpose();
}

float angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// R, turned by the least that brings R * along to `wanted`, where they are further apart than the tolerance.
Mat3 brought(const Mat3& R, const Vec3& along, const Vec3& wanted, float tolerance) {
  if (along.norm() < 1e-6f || angle_between(R * along, wanted) <= tolerance) return R;
  return rotation_between(R * along, wanted) * R;
}

struct Segment {
  int joint;
  Vec3 from, to;
};

/// The bones as segments; hands, feet and head go on beyond their joint.
std::vector<Segment> segments_of(const Joints& joints) {
  std::vector<Segment> out;
  const auto at = [&](int j) -> Vec3 { return joints.row(j).transpose(); };
  const auto add = [&](int j, const Vec3& to) { out.push_back({j, at(j), to}); };
  const float leg = leg_length(joints);
  for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle}) add(j, at(j + 3));
  for (const int j : {LeftShoulder, RightShoulder, LeftElbow, RightElbow}) add(j, at(j + 2));
  for (const int j : {LeftCollar, RightCollar}) add(j, at(j + 3));
  for (const int j : {LeftWrist, RightWrist})
    add(j, at(j) + 0.2f * leg * bone(joints, j - 2, j).normalized());
  for (const int j : {LeftFoot, RightFoot}) add(j, at(j) + 0.08f * leg * Vec3::UnitZ());
  add(Pelvis, at(Spine1));
  out.push_back({Pelvis, at(LeftHip), at(RightHip)});
  add(Spine1, at(Spine2));
  add(Spine2, at(Spine3));
  add(Spine3, at(Neck));
  out.push_back({Spine3, at(LeftCollar), at(RightCollar)});
  add(Neck, at(Head));
  add(Head, at(Head) + 0.2f * leg * Vec3::UnitY());
  return out;
}

/// Distance of a point to a segment; twice as far where it lies behind the segment's first end.
float distance_to(const Vec3& p, const Segment& s) {
  const Vec3 d = s.to - s.from;
  const float t = d.squaredNorm() > 1e-12f ? (p - s.from).dot(d) / d.squaredNorm() : 0.0f;
  const float length = (p - (s.from + std::clamp(t, 0.0f, 1.0f) * d)).norm();
  return t < 0 ? 2 * length : length;
}

void smooth_along(const Faces& faces, int rounds, RowMatrix& weights) {
  for (int round = 0; round < rounds; ++round) {
    RowMatrix sum = weights;
    Eigen::VectorXf count = Eigen::VectorXf::Ones(weights.rows());
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) {
        const int a = faces(f, c), b = faces(f, (c + 1) % 3);
        sum.row(a) += weights.row(b);
        sum.row(b) += weights.row(a);
        count[a] += 1;
        count[b] += 1;
      }
    weights = sum.array().colwise() / count.array();
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
    const auto shoulder = static_cast<size_t>(LeftShoulder + right), elbow = shoulder + 2, wrist = elbow + 2;
    const auto hip = static_cast<size_t>(LeftHip + right), knee = hip + 3;
    Q[shoulder] =
        brought(Mat3::Identity(), bone(bind, LeftShoulder + right, LeftElbow + right), sideways, tolerance);
    Q[elbow] = brought(Q[shoulder], bone(bind, LeftElbow + right, LeftWrist + right), sideways, tolerance);
    Q[wrist] = Q[elbow];
    Q[hip] = brought(Mat3::Identity(), bone(bind, LeftHip + right, LeftKnee + right),
                     bone(human, LeftHip + right, LeftKnee + right), tolerance);
    Q[knee] = brought(Q[hip], bone(bind, LeftKnee + right, LeftAnkle + right),
                      bone(human, LeftKnee + right, LeftAnkle + right), tolerance);
  }
  out.rest.row(Pelvis) = bind.row(Pelvis);
  for (size_t j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    out.largest_deg = std::max(out.largest_deg, geodesic_angle(Mat3::Identity(), Q[j]) * 180 / kPi);
    if (p >= 0)
      out.rest.row(static_cast<int>(j)) =
          out.rest.row(p) + (Q[static_cast<size_t>(p)] * bone(bind, p, static_cast<int>(j))).transpose();
  }
  return out;
}

Points in_t_pose(const Points& vertices, const RowMatrix& weights, const RestPose& pose) {
  return linear_blend_skinning(vertices, weights, pose.bind, {pose.to_rest, pose.rest});
}

RowMatrix geometric_weights(const Mesh& mesh, const Joints& joints) {
  const std::vector<Segment> segments = segments_of(joints);
  RowMatrix weights = RowMatrix::Zero(mesh.vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
    const Vec3 p = mesh.vertices.row(v).transpose();
    std::array<float, kJointCount> nearest;
    nearest.fill(1e9f);
    for (const Segment& s : segments) {
      float& known = nearest[static_cast<size_t>(s.joint)];
      known = std::min(known, distance_to(p, s));
    }
    const float closest = std::max(1e-4f, *std::min_element(nearest.begin(), nearest.end()));
    for (size_t j = 0; j < kJointCount; ++j)
      weights(v, static_cast<int>(j)) = std::pow(closest / std::max(closest, nearest[j]), 6.0f);
    weights.row(v) /= weights.row(v).sum();
  }
  smooth_along(mesh.faces, 4, weights);
  return weights;
}

float heading_of_joints(const Joints& joints) {
  const Vec3 left =
      bone(joints, RightHip, LeftHip).normalized() + bone(joints, RightShoulder, LeftShoulder).normalized();
  return std::atan2(-left.z(), left.x());
}

}  // namespace understudy
