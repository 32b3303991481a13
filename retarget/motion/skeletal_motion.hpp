// The 22 joints of an animated skeleton: what an extraction would give, without a scan.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "retarget/character/prepared_character.hpp"
#include "retarget/formats/import.hpp"
#include "retarget/motion/clip.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/root_path.hpp"

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
  SkeletalMotion(const Character& character, const SkeletalMotionOptions& options);

  int64_t count() const { return times_.count; }
  double fps() const { return times_.fps; }
  /// From the joints to the file's own units and axes.
  Eigen::Matrix4d to_file() const;
  /// Joints, and rotations relative to the T-pose, whatever pose the character was bound in. Joints that the
  /// rig lacks go with the ones above them, at half the confidence.
  Extraction skeleton(int64_t frame) const;
  /// The skinned surface, or its bones.
  Mesh surface(int64_t frame) const;
  const BoneMap& map() const { return c_.map; }
  /// Which of the character's animations it is.
  int clip() const { return clip_; }
  /// The character's nodes, by which the map names bones.
  const Character& character() const { return c_.character; }
  /// What was decided about clip, rate, bones, units, axes and floor, one sentence each.
  const std::vector<std::string>& notes() const { return c_.notes; }

 private:
  PosedNodes posed(int64_t frame) const { return nodes_at(c_.character, clip_, times_.at(frame)); }
  Points to_world(const Points& points) const;
  PosedSkeleton joints(const PosedNodes& nodes) const;
  float lowest(const PosedSkeleton& skeleton) const {
    return skeleton.joints(Pelvis, 1) + support_.lowest(skeleton);
  }
  void bear_joints();
  std::string up_of_motion() const;
  void find_axes(const ImportOptions& import);
  void find_floor(const ImportOptions& import);
  void note_decisions();

  int clip_;
  ClipTimes times_;
  PreparedCharacter c_;
  SupportPoints support_;
  std::array<int, kJointCount> bearer_;      // of each joint the node that moves it
  std::array<Mat3, kJointCount> from_bind_;  // of its node
  Mat3 axes_;                                // the motion's to y up
  float floor_ = 0;                          // after axes and scale
  bool has_skin_;                            // no bones drawn
};

}  // namespace understudy
