// A tree of bones that moves a body of any kind: joints, surface at rest, skin weights; poses and motions.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/math/rigid.hpp"

namespace understudy {

/// How a bone may move against its parent. The root is Free: it turns and goes anywhere.
enum class JointKind { Free, Ball, Hinge, Slider, Fixed };
constexpr std::array<const char*, 5> kJointKindNames = {"free", "ball", "hinge", "slider", "fixed"};
/// Throws Error for another name.
JointKind joint_kind_named(std::string_view name);

/// A joint, and the bone that it carries. At rest no bone is turned.
struct RigJoint {
  std::string name;
  int parent = -1;  ///< -1: the root
  JointKind kind = JointKind::Ball;
  Vec3 rest = Vec3::Zero();   ///< where it is at rest, world, metres
  Vec3 axis = Vec3::UnitY();  ///< unit length, at rest: of a Hinge what it turns about, of a Slider its way
};

constexpr int kSkinBones = 4;
/// Sparse skin weights. Unused entries have weight 0 and any bone.
struct SkinWeights {
  Eigen::Matrix<int, Eigen::Dynamic, kSkinBones, Eigen::RowMajor> bones;      ///< [V, 4] joints
  Eigen::Matrix<float, Eigen::Dynamic, kSkinBones, Eigen::RowMajor> weights;  ///< [V, 4], rows sum to 1
  Eigen::Index size() const { return bones.rows(); }
  /// The bone of a row's largest weight.
  int main_bone(Eigen::Index row) const;
  /// [V, joints]
  RowMatrix dense(int joints) const;
  /// Of every row the four largest, made to sum to 1. Throws Error where a row has nothing positive.
  static SkinWeights from(const RowMatrix& dense);
  /// Every vertex of one bone.
  static SkinWeights rigid(const std::vector<int>& bone_of_vertex);
};

/// The root is joint 0, a parent comes before its children.
struct Rig {
  std::string name;
  std::vector<RigJoint> joints;
  Mesh surface;  ///< at rest
  SkinWeights skin;
  int count() const { return static_cast<int>(joints.size()); }
  Points rest_joints() const;  ///< [J, 3]
};
/// The number of the first bone of that name; -1: none has it.
int bone_named(const Rig& rig, const std::string& name);
/// Throws Error naming what is wrong: no joint, a parent that does not come before, weights that fit neither
/// surface nor joints, numbers that are not finite.
void check_rig(const Rig& rig);

struct RigPose {
  Vec3 root = Vec3::Zero();   ///< where the root joint is, world, metres
  std::vector<Mat3> turns;    ///< [J] against the parent; the root's in the world
  std::vector<float> slides;  ///< [J] metres along the axis; 0 but of sliders
};
/// The rig at rest.
RigPose rest_pose(const Rig& rig);

struct RigMotion {
  double fps = 30;
  std::vector<RigPose> poses;
};

/// A rig and what it performs.
struct RiggedMotion {
  Rig rig;
  RigMotion motion;
};

/// Where each joint takes what it carries, from rest, [J].
using BoneMotions = std::vector<RigidMotion>;
/// Throws Error when pose and rig disagree on the number of joints.
BoneMotions bone_motions(const Rig& rig, const RigPose& pose);
/// Where the joints then are, [J, 3].
Points joint_places(const Rig& rig, const BoneMotions& bones);
/// Linear blend skinning of rest points [V, 3] with these weights. Throws Error for different numbers of
/// them.
Points skinned(const Points& rest, const SkinWeights& skin, const BoneMotions& bones);
/// The pose in which every joint allows what these motions ask for, as nearly as its kind lets it.
RigPose pose_of(const Rig& rig, const BoneMotions& bones);

/// Where the bones that carry no other end, at rest: beyond their farthest vertices. One a such bone, in the
/// order of the joints; nothing but for what has a surface.
struct BoneTip {
  int joint;
  Vec3 rest;
};
std::vector<BoneTip> bone_tips(const Rig& rig);

/// For each joint those that it carries directly.
std::vector<std::vector<int>> children_of(const Rig& rig);

}  // namespace understudy
