// A dancer, a body of points around its bones, and stand-ins for the networks.
#pragma once

#include <cmath>
#include <memory>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/retargeter.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::fixtures {

/// A pose that moves every joint, smooth in time.
inline Pose dance(float t) {
  Pose pose;
  const auto turn = [&](int j, float x, float y, float z) {
    pose.local[j] = rotation_from_axis_angle(Vec3(x, y, z));
  };
  turn(Pelvis, 0.1f * std::sin(t), 0.5f * t, 0.05f);
  turn(Spine1, 0.15f, 0.1f * std::sin(t), 0);
  turn(Spine3, 0.05f, 0.1f * std::sin(t), 0.05f);
  turn(LeftHip, -0.5f - 0.4f * std::sin(t), 0.1f, 0.1f);
  turn(RightHip, -0.5f + 0.4f * std::sin(t), -0.1f, -0.1f);
  turn(LeftKnee, 0.9f + 0.3f * std::sin(2 * t), 0, 0);
  turn(RightKnee, 0.9f - 0.3f * std::sin(2 * t), 0, 0);
  turn(LeftShoulder, 0.2f, -0.4f, -0.8f + 0.3f * std::sin(t));
  turn(RightShoulder, 0.1f, 0.3f, 0.9f + 0.3f * std::sin(t));
  turn(LeftElbow, 0, -0.87f * (0.9f + 0.2f * std::sin(t)), 0.49f * (0.9f + 0.2f * std::sin(t)));
  turn(RightElbow, 0, 0.87f * 0.8f, -0.49f * 0.8f);
  turn(Head, 0, 0.4f, 0);
  pose.root = Vec3(0.4f * t, 0.95f + 0.03f * std::sin(3 * t), 0.2f * std::sin(t));
  return pose;
}

/// Another person: longer legs, shorter arms, broad.
inline Joints other_body() {
  auto lengths = bone_lengths(human_rest());
  for (const int j : {LeftKnee, RightKnee, LeftAnkle, RightAnkle}) lengths[j] *= 0.8f;
  for (const int j : {LeftElbow, RightElbow}) lengths[j] *= 0.7f;
  for (const int j : {LeftShoulder, RightShoulder, LeftHip, RightHip}) lengths[j] *= 1.2f;
  return rest_with_lengths(human_rest(), lengths);
}

/// Points in small rings around each bone of a T-pose, each wholly with the bone's upper joint; soles under
/// the feet.
struct PointBody {
  Mesh mesh;
  RowMatrix weights;
  explicit PointBody(const Joints& rest) {
    std::vector<Vec3> points;
    std::vector<int> joint;
    for (int j = 1; j < kJointCount; ++j)
      for (int k = 0; k < 24; ++k) {
        const Vec3 a = rest.row(kParents[j]).transpose(), b = rest.row(j).transpose();
        const float angle = 0.8f * static_cast<float>(k);
        points.push_back(a + (b - a) * (static_cast<float>(k) / 24) +
                         0.05f * Vec3(std::cos(angle), 0, std::sin(angle)));
        joint.push_back(kParents[j]);
      }
    for (const int j : {LeftAnkle, RightAnkle})
      for (int k = 0; k < 60; ++k) {
        points.push_back(rest.row(j).transpose() + Vec3(0.004f * static_cast<float>(k % 10) - 0.02f, -0.1f,
                                                        0.004f * static_cast<float>(k) - 0.06f));
        joint.push_back(j);
      }
    const auto count = static_cast<Eigen::Index>(points.size());
    mesh.vertices.resize(count, 3);
    weights = RowMatrix::Zero(count, kJointCount);
    for (Eigen::Index i = 0; i < count; ++i) {
      mesh.vertices.row(i) = points[static_cast<size_t>(i)].transpose();
      weights(i, joint[static_cast<size_t>(i)]) = 1;
    }
  }
};

/// Linear blend skinning with known weights, in the deformer's place.
class RigidDeformer final : public Deformer {
 public:
  explicit RigidDeformer(RowMatrix weights) : weights_(std::move(weights)) {}
  void bind(const Points& rest, const Joints& rest_joints) override { rest_ = rest, joints_ = rest_joints; }
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override {
    auto other = std::make_shared<RigidDeformer>(*this);
    other->weights_ = std::move(weights);
    return other;
  }
  Points offsets(const Pose&) const override { return Points::Zero(rest_.rows(), 3); }
  Points deform(const Pose& pose) const override {
    return linear_blend_skinning(rest_, weights_, joints_, forward_kinematics(joints_, pose));
  }
  std::string name() const override { return "rigid"; }

 private:
  RowMatrix weights_;
  Points rest_;
  Joints joints_ = Joints::Zero();
};

/// An extractor that knows the answer: a scan's last 22 points are the joints.
class TellTaleExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    US_CHECK(scan.vertices.rows() >= kJointCount, "too few points");
    Extraction e;
    e.joints = scan.vertices.bottomRows<kJointCount>();
    e.confidence.setConstant(confidence);
    return e;
  }
  std::string name() const override { return "telltale"; }
  float confidence = 1;
};

inline Mesh scan_of(const PointBody& body, const Joints& rest, const Pose& pose) {
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  const Points points = linear_blend_skinning(body.mesh.vertices, body.weights, rest, posed);
  Mesh scan;
  scan.vertices.resize(points.rows() + kJointCount, 3);
  scan.vertices << points, posed.joints;
  return scan;
}

inline Observation seen(const Joints& joints) {
  Observation e;
  e.joints = joints;
  return e;
}

}  // namespace understudy::fixtures
