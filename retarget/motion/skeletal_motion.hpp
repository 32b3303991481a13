// The 22 joints of an animated skeleton: what an extraction would give, without a scan.
#pragma once

#include <memory>
#include <string>

#include "retarget/character/bone_map.hpp"
#include "retarget/character/character.hpp"
#include "retarget/formats/import.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

struct SkeletalMotionOptions {
  std::string clip;      ///< name or number from 1; empty: the longest
  BoneChoices bones;     ///< the user's corrections of the map
  ImportOptions import;  ///< `up` is that of the motion; the rig's own is seen in its bones
  double fps = 0;        ///< 0: that of the keys
};

/// An animation of a rigged character, with a skin or bones alone, in metres, y up, the floor at 0, turned so
/// that its bind pose faces +z. Any frame at any time; const, so from several threads at once.
class SkeletalMotion {
 public:
  /// Throws Error naming the character: no animation, no such clip, bones that are not known.
  SkeletalMotion(Character character, const SkeletalMotionOptions& options);
  ~SkeletalMotion();
  SkeletalMotion(SkeletalMotion&&) noexcept;

  int64_t count() const;
  double fps() const;
  /// From the joints to the file's own units and axes.
  Eigen::Matrix4d to_file() const;
  /// Joints, and rotations relative to the T-pose, whatever pose the character was bound in. Joints that the
  /// rig lacks go with the ones above them, at half the confidence.
  Extraction skeleton(int64_t frame) const;
  /// The skinned surface, or its bones.
  Mesh surface(int64_t frame) const;
  const BoneMap& map() const;
  /// Which of the character's animations it is.
  int clip() const;
  /// The character's nodes, by which the map names bones.
  const Character& character() const;
  /// What was decided about clip, rate, bones, units, axes and floor, one sentence each.
  const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace understudy
