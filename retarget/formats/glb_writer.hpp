// An animated, skinned character as a binary glTF 2.0 (.glb) that any engine opens.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What is written once: a target in T-pose with its skin.
struct GlbCharacter {
  Mesh mesh;          ///< T-pose; a cloud is written as POINTS
  Joints joints;      ///< T-pose joints
  RowMatrix weights;  ///< [V, 22]; the best four of each vertex are kept and made to sum to 1
  std::string name = "Understudy";
};

/// Takes poses frame by frame (under 500 bytes each are kept), writes everything in finish(): beside the path
/// first, then renamed.
class GlbWriter {
 public:
  /// Throws Error when sizes disagree or the character has numbers that are not finite.
  GlbWriter(const std::string& path, GlbCharacter character);
  /// Times in seconds, increasing. Throws Error when they are not or the pose is not finite.
  void push(const Pose& pose, float time_s);
  /// Throws Error when the file cannot be written or would pass glTF's 4 GB.
  void finish();
  size_t frames() const { return times_.size(); }

 private:
  std::string path_;
  GlbCharacter character_;
  std::vector<float> times_;                                 // [T]
  std::vector<float> roots_;                                 // [T, 3]
  std::array<std::vector<float>, kJointCount> quaternions_;  // each [T, 4], x y z w
};

}  // namespace understudy
