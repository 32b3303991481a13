// Which of a rig's bones are the 22 joints: by their names, their hierarchy and where they are.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "retarget/character/character.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The node of each joint, -1 for none, and how sure that is.
struct BoneMap {
  std::array<int, kJointCount> node;
  /// 0..1: 1 name and hierarchy, 0.8 name alone, 0.5 place, 0 none
  std::array<float, kJointCount> confidence;
  std::string how;  ///< "by names (Mixamo)", "by hierarchy and position", "given"
  BoneMap() {
    node.fill(-1);
    confidence.fill(0);
  }
  bool has(int joint) const { return node[joint] >= 0; }
  int count() const;
  /// Both hips, knees, shoulders and elbows: enough to drive the rig.
  bool usable() const;
};

/// What a bone's name says, whoever named it (Mixamo, Rigify, CMU, Unreal, VRM, biped, SMPL, words with left
/// and right): the side and what it is, as in "Bip01 L UpperArm" -> {-1: left, "upperarm"}.
struct BoneName {
  int side = 0;  ///< -1 left, 1 right, 0 neither
  std::string what;
};
BoneName parse_bone_name(const std::string& name);

/// Joints to bones as the user wants them: name of the joint ("left_wrist") to the node's; an empty name
/// takes the joint away.
using BoneChoices = std::map<std::string, std::string>;
/// A file of them, a JSON object: {"left_wrist": "Hand.L"}. Throws Error naming `path`.
BoneChoices parse_bone_choices(std::string_view text, const std::string& path);
BoneChoices read_bone_choices(const std::string& path);

/// Maps by names where they are clear, else by hierarchy and position. bind: the nodes' transforms in the
/// bind pose, y up (any heading). The user's choices come last. Throws Error when a choice names a joint or a
/// bone that does not exist, or one bone twice.
BoneMap map_bones(const Character& character, const std::vector<Mat4>& bind, const BoneChoices& choices = {});

/// A line a joint: its name, the bone, how sure.
std::string to_table(const BoneMap& map, const Character& character);

}  // namespace understudy
