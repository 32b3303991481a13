// Which bones of two bodies of a kind are each other's, and which of their poses are the same.
#pragma once

#include <vector>

#include "retarget/discovery/proportion_fit.hpp"

namespace understudy {

/// Of each bone of a target its partner in a source, one to one.
struct BoneMatches {
  std::vector<int> partner;  ///< [J of the target] bone of the source; -1: none, it follows its neighbours
  std::vector<float> cost;  ///< [J] share of both bones that the other one is not; of those without partner 0
};
/// Throws Error where a partner is no bone of the source, two bones have the same, or no bone has one.
void check_matches(const BoneMatches& matches, const Rig& source, const Rig& target);

/// A source's body laid on a target's, in the two of their poses that are most alike.
struct LaidBody {
  int source_frame = 0, target_frame = 0;
  /// From the source's space to the target's: about y, perhaps a mirror in x first.
  Mat3 turn = Mat3::Identity();
  float scale = 1;  ///< the target's size over the source's
  /// [J of the source] from how a bone lies on the target to how it was posed, in the target's space.
  std::vector<Mat3> corrections;
  Points points, joints;  ///< of the source, on the target [N, 3], [J, 3]
  SkinWeights skin;       ///< of the points
  bool mirrored() const { return turn.determinant() < 0; }
};
/// Looks for the poses and the heading in which both bodies' surfaces are most alike, then fits the source's
/// proportions. A mirrored body must be much more alike. Throws Error for bodies without a surface or a pose.
LaidBody lay_on(const RiggedMotion& source, const RiggedMotion& target);

/// Partners have most of their surfaces in common where the source is laid on the target.
BoneMatches match_bones(const LaidBody& laid, const RiggedMotion& source, const RiggedMotion& target);

/// [J] each bone's nearest one with a partner along the target's tree, itself first, then towards the root.
std::vector<int> led_by(const Rig& target, const BoneMatches& matches);

}  // namespace understudy
