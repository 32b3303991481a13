#include "retarget/character/own_bones.hpp"

#include <algorithm>
#include <set>

#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kMoves = 1e-5f;  // metres that a bone leaves its place on its parent by

/// Nodes that are bones, and the one above all of them where several have none above.
std::vector<bool> bone_nodes(const PreparedCharacter& c) {
  const auto& nodes = c.character.nodes;
  std::vector<bool> is_bone = c.bind.is_bone;
  for (size_t n = 0; n < nodes.size(); ++n)
    if (c.driver[n] >= 0) is_bone[n] = true;
  const auto bone_above = [&](int n) {
    for (n = nodes[n].parent; n >= 0 && !is_bone[n];) n = nodes[n].parent;
    return n;
  };
  std::vector<int> tops;
  for (size_t n = 0; n < nodes.size(); ++n)
    if (is_bone[n] && bone_above(static_cast<int>(n)) < 0) tops.push_back(static_cast<int>(n));
  if (tops.size() < 2) return is_bone;
  for (int n = nodes[tops[0]].parent; n >= 0; n = nodes[n].parent)
    if (std::all_of(tops.begin(), tops.end(), [&](int top) { return c.character.is_at_or_below(top, n); })) {
      is_bone[n] = true;
      break;
    }
  return is_bone;
}

/// Where the bones are in a pose: turned from the bind pose about their parents' axes, and their heads on
/// their parents, in those, metres; of a bone without a parent in the world.
struct PosedBones {
  std::vector<Mat3> local;
  Points places;
};
PosedBones posed_bones(const PreparedCharacter& c, const std::vector<OwnBone>& bones, const Joints& rest,
                       const Pose& pose) {
  const std::vector<Mat4> moved = node_motions(c, rest, pose);
  PosedBones out;
  out.places.resize(ssize(bones), 3);
  std::vector<Vec3> heads;
  for (size_t b = 0; b < bones.size(); ++b) {
    const Mat4& M = moved[bones[b].node];
    const Mat3 R = M.topLeftCorner<3, 3>();
    heads.push_back(R * bones[b].rest + M.topRightCorner<3, 1>());
    const int p = bones[b].parent;
    const Mat3 back =
        p < 0 ? Mat3(Mat3::Identity()) : Mat3(moved[bones[p].node].topLeftCorner<3, 3>().transpose());
    out.local.push_back(back * R);
    out.places.row(static_cast<Eigen::Index>(b)) =
        (back * (p < 0 ? heads[b] : Vec3(heads[b] - heads[p]))).transpose();
  }
  return out;
}

/// Whether poses move bones on their parents: it shows in any pose that turns all joints.
std::vector<bool> moving_bones(const PreparedCharacter& c, const std::vector<OwnBone>& bones,
                               const Joints& rest) {
  constexpr int kPoses = 4;
  std::vector<bool> moves(bones.size(), false);
  Rng rng(1);
  for (int i = 0; i < kPoses; ++i) {
    Pose pose;
    pose.root = Vec3(rng.uniform(), 1 + rng.uniform(), rng.uniform());
    for (Mat3& R : pose.local)
      R = rotation_from_axis_angle({rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f});
    const PosedBones posed = posed_bones(c, bones, rest, pose);
    for (size_t b = 0; b < bones.size(); ++b) {
      const int p = bones[b].parent;
      if (p < 0) continue;
      const Vec3 still = bones[b].rest - bones[p].rest;
      const Vec3 place = posed.places.row(static_cast<Eigen::Index>(b)).transpose();
      moves[b] = moves[b] || (place - still).norm() > kMoves;
    }
  }
  return moves;
}

std::vector<BvhJoint> file_joints(const PreparedCharacter& c, const std::vector<OwnBone>& bones,
                                  const Joints& rest) {
  const std::vector<bool> moves = moving_bones(c, bones, rest);
  std::vector<BvhJoint> joints;
  for (size_t b = 0; b < bones.size(); ++b)
    joints.push_back({bones[b].name, bones[b].parent, bones[b].rest, moves[b]});
  return joints;
}

}  // namespace

std::vector<Mat4> node_motions(const PreparedCharacter& c, const Joints& rest, const Pose& pose) {
  const Joints about = moved_bind_joints(c.pose, rest);
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  std::vector<Mat4> moved;
  for (size_t n = 0; n < c.driver.size(); ++n) {
    const int p = c.character.nodes[n].parent, j = c.driver[n];
    if (j < 0) {
      moved.push_back(p < 0 ? Mat4(Mat4::Identity()) : moved[p]);
      continue;
    }
    const Mat3 R = posed.global[j] * c.pose.to_rest[j];
    moved.push_back(affine(R, posed.joints.row(j).transpose() - R * about.row(j).transpose()));
  }
  return moved;
}

std::vector<OwnBone> own_bones(const PreparedCharacter& c) {
  US_CHECK(c.rigged, c.character.called(), ": has no bones of its own that are known");
  const std::vector<bool> is_bone = bone_nodes(c);
  const auto& nodes = c.character.nodes;
  std::vector<OwnBone> bones;
  std::vector<int> bone_of(nodes.size(), -1);  // the node itself, or the nearest above
  std::set<std::string> taken;
  for (size_t n = 0; n < nodes.size(); ++n) {
    const int above = nodes[n].parent < 0 ? -1 : bone_of[nodes[n].parent];
    bone_of[n] = above;
    if (!is_bone[n]) continue;
    bone_of[n] = static_cast<int>(bones.size());
    const Vec3 in_file = c.bind.nodes[n].topRightCorner<3, 1>();
    bones.push_back({static_cast<int>(n), above, c.to_world.scale * (c.to_world.R * in_file) + c.to_world.t,
                     bvh_word(nodes[n].name, n, taken)});
  }
  return bones;
}

OwnBonesBvh::OwnBonesBvh(const std::string& path, std::shared_ptr<const PreparedCharacter> character,
                         const Joints& rest, double fps)
    : character_(std::move(character)),
      rest_(rest),
      bones_(own_bones(*character_)),
      file_(path, file_joints(*character_, bones_, rest), fps) {}

void OwnBonesBvh::push(const Pose& pose) {
  const PosedBones posed = posed_bones(*character_, bones_, rest_, pose);
  file_.push(posed.local, posed.places);
}

}  // namespace understudy
