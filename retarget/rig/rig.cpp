#include "retarget/rig/rig.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// The turn about `axis` that is nearest to R.
Mat3 turn_about(const Mat3& R, const Vec3& axis) {
  const Eigen::Quaternionf q(R);
  const float along = q.vec().dot(axis);
  if (std::abs(along) + std::abs(q.w()) < 1e-6f) return Mat3::Identity();
  return Eigen::Quaternionf(q.w(), along * axis.x(), along * axis.y(), along * axis.z())
      .normalized()
      .toRotationMatrix();
}

Mat3 allowed_turn(const RigJoint& joint, const Mat3& wanted) {
  switch (joint.kind) {
    case JointKind::Hinge:
      return turn_about(wanted, joint.axis);
    case JointKind::Slider:
    case JointKind::Fixed:
      return Mat3::Identity();
    case JointKind::Free:
    case JointKind::Ball:
      break;
  }
  // What a product of floats is off a rotation would double with each joint of a chain.
  return Eigen::Quaternionf(wanted).normalized().toRotationMatrix();
}

RigidMotion moved(const RigJoint& joint, const Mat3& R, const Vec3& place) {
  return {R, place - R * joint.rest};
}

Vec3 place_on(const RigJoint& joint, const RigidMotion& parent, float slide) {
  return parent(joint.rest) + slide * (parent.R * joint.axis);
}

}  // namespace

JointKind joint_kind_named(std::string_view name) {
  const auto found = std::find(kJointKindNames.begin(), kJointKindNames.end(), name);
  US_CHECK(found != kJointKindNames.end(), "'", std::string(name), "' is no kind of joint");
  return static_cast<JointKind>(found - kJointKindNames.begin());
}

int SkinWeights::main_bone(Eigen::Index row) const {
  Eigen::Index most;
  weights.row(row).maxCoeff(&most);
  return bones(row, most);
}

RowMatrix SkinWeights::dense(int joints) const {
  RowMatrix all = RowMatrix::Zero(size(), joints);
  for (Eigen::Index v = 0; v < size(); ++v)
    for (int k = 0; k < kSkinBones; ++k)
      if (weights(v, k) > 0) all(v, bones(v, k)) += weights(v, k);
  return all;
}

SkinWeights SkinWeights::from(const RowMatrix& dense) {
  SkinWeights skin;
  skin.bones.setZero(dense.rows(), kSkinBones);
  skin.weights.setZero(dense.rows(), kSkinBones);
  std::vector<int> order(static_cast<size_t>(dense.cols()));
  const auto kept = static_cast<int>(std::min<Eigen::Index>(kSkinBones, dense.cols()));
  for (Eigen::Index v = 0; v < dense.rows(); ++v) {
    std::iota(order.begin(), order.end(), 0);
    std::partial_sort(order.begin(), order.begin() + kept, order.end(), [&](int a, int b) {
      return dense(v, a) != dense(v, b) ? dense(v, a) > dense(v, b) : a < b;
    });
    for (int k = 0; k < kept; ++k) {
      skin.bones(v, k) = order[static_cast<size_t>(k)];
      skin.weights(v, k) = std::max(0.0f, dense(v, order[static_cast<size_t>(k)]));
    }
    const float sum = skin.weights.row(v).sum();
    US_CHECK(sum > 0, "vertex ", v, " hangs on no bone");
    skin.weights.row(v) /= sum;
  }
  return skin;
}

SkinWeights SkinWeights::rigid(const std::vector<int>& bone_of_vertex) {
  SkinWeights skin;
  const auto count = static_cast<Eigen::Index>(bone_of_vertex.size());
  skin.bones.setZero(count, kSkinBones);
  skin.weights.setZero(count, kSkinBones);
  skin.weights.col(0).setOnes();
  for (Eigen::Index v = 0; v < count; ++v) skin.bones(v, 0) = bone_of_vertex[static_cast<size_t>(v)];
  return skin;
}

Points Rig::rest_joints() const {
  Points places(count(), 3);
  for (int j = 0; j < count(); ++j) places.row(j) = joints[static_cast<size_t>(j)].rest.transpose();
  return places;
}

int bone_named(const Rig& rig, const std::string& name) {
  const auto found = std::find_if(rig.joints.begin(), rig.joints.end(),
                                  [&](const RigJoint& joint) { return joint.name == name; });
  return found == rig.joints.end() ? -1 : static_cast<int>(found - rig.joints.begin());
}

void check_rig(const Rig& rig) {
  US_CHECK(rig.count() > 0, rig.name, ": a rig without joints");
  for (int j = 0; j < rig.count(); ++j) {
    const RigJoint& joint = rig.joints[static_cast<size_t>(j)];
    US_CHECK(j == 0 ? joint.parent == -1 : joint.parent >= 0 && joint.parent < j, rig.name, ": joint ", j,
             " hangs on ", joint.parent, ", which does not come before it");
    US_CHECK(joint.rest.allFinite() && joint.axis.allFinite(), rig.name, ": joint ", j, " is nowhere");
  }
  const Eigen::Index vertices = rig.surface.vertices.rows();
  US_CHECK(rig.skin.size() == vertices && rig.skin.weights.rows() == vertices, rig.name, ": ",
           rig.skin.size(), " rows of weights for ", vertices, " vertices");
  US_CHECK(rig.surface.vertices.allFinite() && rig.skin.weights.allFinite(), rig.name,
           ": a vertex or a weight is not finite");
  US_CHECK(vertices == 0 || (rig.skin.bones.minCoeff() >= 0 && rig.skin.bones.maxCoeff() < rig.count()),
           rig.name, ": a weight is of a joint that is not there");
}

RigPose rest_pose(const Rig& rig) {
  RigPose pose;
  pose.root = rig.joints.at(0).rest;
  pose.turns.assign(rig.joints.size(), Mat3::Identity());
  pose.slides.assign(rig.joints.size(), 0.0f);
  return pose;
}

BoneMotions bone_motions(const Rig& rig, const RigPose& pose) {
  US_CHECK(pose.turns.size() == rig.joints.size() && pose.slides.size() == rig.joints.size(), "a pose of ",
           pose.turns.size(), " joints for a rig of ", rig.joints.size());
  BoneMotions bones(rig.joints.size());
  for (size_t j = 0; j < bones.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    if (joint.parent < 0) {
      bones[j] = moved(joint, pose.turns[j], pose.root);
      continue;
    }
    const RigidMotion& parent = bones[static_cast<size_t>(joint.parent)];
    bones[j] = moved(joint, parent.R * pose.turns[j], place_on(joint, parent, pose.slides[j]));
  }
  return bones;
}

Points joint_places(const Rig& rig, const BoneMotions& bones) {
  Points places(rig.count(), 3);
  for (size_t j = 0; j < bones.size(); ++j)
    places.row(static_cast<Eigen::Index>(j)) = bones[j](rig.joints[j].rest).transpose();
  return places;
}

Points skinned(const Points& rest, const SkinWeights& skin, const BoneMotions& bones) {
  US_CHECK(skin.size() == rest.rows(), skin.size(), " rows of weights for ", rest.rows(), " points");
  Points posed(rest.rows(), 3);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const Vec3 x = rest.row(v).transpose();
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSkinBones; ++k)
      if (skin.weights(v, k) > 0) sum += skin.weights(v, k) * bones[static_cast<size_t>(skin.bones(v, k))](x);
    posed.row(v) = sum.transpose();
  }
  return posed;
}

RigPose pose_of(const Rig& rig, const BoneMotions& bones) {
  US_CHECK(bones.size() == rig.joints.size(), bones.size(), " motions for a rig of ", rig.joints.size(),
           " joints");
  RigPose pose = rest_pose(rig);
  BoneMotions made(bones.size());  // as this rig can: what hangs on a joint is told against what it did
  for (size_t j = 0; j < bones.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    if (joint.parent < 0) {
      pose.turns[j] = bones[j].R;
      pose.root = bones[j](joint.rest);
      made[j] = moved(joint, pose.turns[j], pose.root);
      continue;
    }
    const RigidMotion& parent = made[static_cast<size_t>(joint.parent)];
    pose.turns[j] = allowed_turn(joint, parent.R.transpose() * bones[j].R);
    if (joint.kind == JointKind::Slider)
      pose.slides[j] = (bones[j](joint.rest) - parent(joint.rest)).dot(parent.R * joint.axis);
    made[j] = moved(joint, parent.R * pose.turns[j], place_on(joint, parent, pose.slides[j]));
  }
  return pose;
}

std::vector<std::vector<int>> children_of(const Rig& rig) {
  std::vector<std::vector<int>> children(rig.joints.size());
  for (int j = 1; j < rig.count(); ++j)
    children[static_cast<size_t>(rig.joints[static_cast<size_t>(j)].parent)].push_back(j);
  return children;
}

std::vector<BoneTip> bone_tips(const Rig& rig) {
  const auto children = children_of(rig);
  std::vector<std::vector<Eigen::Index>> vertices(rig.joints.size());
  for (Eigen::Index v = 0; v < rig.skin.size(); ++v)
    vertices[static_cast<size_t>(rig.skin.main_bone(v))].push_back(v);
  std::vector<BoneTip> tips;
  for (int j = 1; j < rig.count(); ++j) {
    const auto& own = vertices[static_cast<size_t>(j)];
    if (!children[static_cast<size_t>(j)].empty() || own.empty()) continue;
    // Through the middle of the bone's vertices as far as the farthest of them.
    const Vec3 joint = rig.joints[static_cast<size_t>(j)].rest;
    Vec3 middle = Vec3::Zero();
    for (const Eigen::Index v : own) middle += rig.surface.vertices.row(v).transpose();
    const Vec3 along = (middle / static_cast<float>(own.size()) - joint).normalized();
    float length = 0;
    for (const Eigen::Index v : own)
      length = std::max(length, along.dot(rig.surface.vertices.row(v).transpose() - joint));
    tips.push_back({j, joint + length * along});
  }
  return tips;
}

}  // namespace understudy
