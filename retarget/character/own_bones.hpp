// The bones of a rigged character as poses of the 22 joints move them: in the world, and as a BVH file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/character/prepared_character.hpp"
#include "retarget/formats/motion_writers.hpp"

namespace understudy {

/// Of each node of the file how it moves in the world from the bind pose, metres: turned and shifted, never
/// scaled. rest: the T-pose joints that the pose turns, metres.
std::vector<Mat4> node_motions(const PreparedCharacter& character, const Joints& rest, const Pose& pose);

/// A bone of a character. Bones are nodes that a skin has, or that poses move.
struct OwnBone {
  int node = 0;              ///< of the file
  int parent = -1;           ///< among the bones, where it comes before; below 0: none is above
  Vec3 rest = Vec3::Zero();  ///< its head in the bind pose, in the world, metres
  std::string name;          ///< without blanks, unlike any other
};
/// Parents first. Where several bones have none above, the node above all of them is a bone, too,
/// if there is one.
/// Throws Error naming the character: its bones are not known.
std::vector<OwnBone> own_bones(const PreparedCharacter& character);

/// BVH of the character's own bones, with its bind pose where all angles are zero; see BvhWriter. A bone that
/// moves on its parent has its position in each frame.
class OwnBonesBvh {
 public:
  /// rest: the T-pose joints, metres. Throws Error: bones that are not known, and as BvhWriter.
  OwnBonesBvh(const std::string& path, std::shared_ptr<const PreparedCharacter> character, const Joints& rest,
              double fps);
  void push(const Pose& pose);
  void finish() { file_.finish(); }

 private:
  std::shared_ptr<const PreparedCharacter> character_;
  Joints rest_;
  std::vector<OwnBone> bones_;
  BvhWriter file_;
};

}  // namespace understudy
