// What the names of bones say, in any of the usual conventions and languages.
#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

namespace understudy {

/// What a bone can be; both sides are one role.
enum class BoneRole {
  Pelvis,
  Spine,
  Chest,
  Neck,
  Head,
  Collar,
  Shoulder,
  Elbow,
  Wrist,
  Hip,
  Knee,
  Ankle,
  Toe
};
constexpr int kBoneRoles = 13;

/// What a bone's name says: the side and the part of the body, as in "Bip01 L UpperArm" -> {-1, "upperarm"}.
struct BoneName {
  int side = 0;  ///< -1 left, 1 right, 0 neither
  /// The part; empty: none known, or a helper
  std::string what;
  bool is_helper = false;  ///< twist, IK, finger, hair, eye, skirt: no joint
  int number = -1;         ///< the last in it; -1: none
  int unknown = 0;         ///< words of three letters or more that say nothing
  std::string key;         ///< its words without the side: equal for a bone and its mirror image
  /// Evidence for a role, as log odds: 3 its very word, 0 nothing known, below 0 the word of another part.
  float evidence(BoneRole role) const;
};

/// Mixamo, Biped, CAT, Rigify, Maya, DAZ, Poser, VRM, MMD, Unreal, Source, CMU, SMPL, words. `ignored`: words
/// that say nothing in this rig.
BoneName parse_bone_name(const std::string& name, const std::set<std::string>& ignored = {});

/// The words that nearly all of the names have, such as the character's own.
std::set<std::string> common_words(const std::vector<std::string>& names);

}  // namespace understudy
