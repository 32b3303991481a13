// The mapping of a rig as a whole that its names, hierarchy, symmetry, places and skin speak for most.
#pragma once

#include <array>

#include "retarget/character/bone_tree.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What a bone of this joint is.
BoneRole role_of(int joint);

/// The bone of each joint in a tree, -1 for none.
struct FoundBones {
  std::array<int, kJointCount> bone;
  std::array<float, kJointCount> evidence;  ///< of its name, as log odds
  std::array<float, kJointCount> margin;    ///< by how much the best mapping with another bone there is worse
  float shape = 0;                          ///< evidence of places and skin; 0: a person's
  bool sides_by_shape = false;              ///< the side words say the opposite
  bool found = false;                       ///< a whole body
};

/// Scores whole bodies: a pair of legs, a pair of arms, pelvis, spine, neck and head, from the likeliest of
/// each. Which side is left is seen in the feet, else in the words.
FoundBones search_bones(const BoneTree& tree);

}  // namespace understudy
