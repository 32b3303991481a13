// A rig's bones as evidence: what they are called, where they are, what they move, which mirrors which.
#pragma once

#include <vector>

#include "retarget/character/bone_names.hpp"
#include "retarget/character/character.hpp"

namespace understudy {

struct TreeBone {
  int node = -1;           ///< of the character
  int parent = -1;         ///< the nearest candidate above, -1 for none
  std::vector<int> below;  ///< its children
  int depth = 0, end = 0;  ///< bones in its branch have numbers from its own to end - 1
  Vec3 at = Vec3::Zero();  ///< in the bind pose
  BoneName name;
  float rank = 0;              ///< how many bones of the same name have lower numbers
  float mass = 0, total = 0;   ///< the share of the surface that it moves, and that its branch moves
  Vec3 middle = Vec3::Zero();  ///< of what its branch moves; its own place where that is nothing
  float reach = 0;             ///< the furthest that its branch moves or has bones, from it
  int mirror = -1;             ///< the bone across the body, -1 for none
  float across = 0;            ///< signed distance from the middle of the body
};

/// Bones that may be joints, parents before children, each branch in one piece: those of skins, what is above
/// them, and what is below with the name of a joint. Without a skin every node.
struct BoneTree {
  std::vector<TreeBone> bones;
  float size = 0;            ///< the longest side of the box around the bones
  bool has_surface = false;  ///< masses are known
  bool has_plane = false;    ///< the bones are symmetric about it
  Vec3 normal = Vec3::Zero();
  Points surface{0, 3};  ///< some points of it in the bind pose

  bool is_above(int a, int b) const { return a <= b && b < bones[a].end; }
  int common(int a, int b) const;
  /// From below `top` down to `end`, both in (top, end].
  std::vector<int> path(int top, int end) const;
};

/// bind: the nodes' transforms in the bind pose. Rigs of more than some thousand bones lose the last ones.
BoneTree make_bone_tree(const Character& character, const std::vector<Mat4>& bind);

}  // namespace understudy
