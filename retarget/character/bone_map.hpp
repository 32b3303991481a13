// Which of a rig's bones are the 22 joints: by names, hierarchy, symmetry, places and what they move.
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
  /// 0..1: 1 its name and all else, 0.8 its name, where another bone fits nearly as well; 0.5 its place, 0.4
  /// that, where another fits nearly as well; 0 none
  std::array<float, kJointCount> confidence;
  std::string how;                         ///< "by names (Mixamo)", "by hierarchy and position", "given"
  static constexpr float kGuessed = 0.7f;  ///< below it a joint's bone is a guess
  BoneMap() {
    node.fill(-1);
    confidence.fill(0);
  }
  bool has(int joint) const { return node[joint] >= 0; }
  int count() const;
  /// Both hips, knees, shoulders and elbows: enough to drive the rig.
  bool usable() const;
  /// The joints whose bones are guesses, by place and not by name.
  std::vector<int> guessed() const;
};

/// Joints to bones as the user wants them: name of the joint ("left_wrist") to the node's; an empty name
/// takes the joint away.
using BoneChoices = std::map<std::string, std::string>;
/// A file of them, a JSON object: {"left_wrist": "Hand.L"}. Throws Error naming `path`.
BoneChoices parse_bone_choices(std::string_view text, const std::string& path);
BoneChoices read_bone_choices(const std::string& path);

/// The mapping of the whole body for which most speaks: names, side words, hierarchy, symmetry, places, what
/// bones move. bind: the nodes' transforms in the bind pose, any axis up, any unit. The user's choices come
/// last. Throws Error when a choice names a joint or a bone that does not exist, or one bone twice.
BoneMap map_bones(const Character& character, const std::vector<Mat4>& bind, const BoneChoices& choices = {});

/// Names the joints whose bones are guesses; empty: none is.
std::string guess_note(const BoneMap& map);
/// A line a joint: its name, the bone, how sure.
std::string to_table(const BoneMap& map, const Character& character);

}  // namespace understudy
