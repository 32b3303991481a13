// Which bones of two bodies of a kind are each other's, and which of their poses are the same.
#pragma once

#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/discovery/proportion_fit.hpp"

namespace understudy {

/// Of each bone of a target its partner in a source, one to one.
struct BoneMatches {
  std::vector<int> partner;  ///< [J of the target] bone of the source; -1: none, it follows its neighbours
  std::vector<float> cost;  ///< [J] share of both bones that the other one is not; of those without partner 0
};
/// Which of the target's bones performs a bone of the source; -1: none does.
int performer_of(const BoneMatches& matches, int bone);
/// A bone of a source and the one of a target that performs it, as somebody chose.
struct ChosenMatch {
  std::string bone, partner;  ///< names; partner empty: no bone of the target does
};
template <class V, class S>
FieldsOf<S, ChosenMatch> fields(V& visit, S& match) {
  visit("bone", match.bone);
  visit("partner", match.partner);
}
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

/// [J of the target, J of the source] share of both bones' surfaces that the other one is not, where the
/// source is laid on the target: 0 all the same .. 1 nothing in common.
Eigen::MatrixXd bone_costs(const LaidBody& laid, const RiggedMotion& source, const RiggedMotion& target);
/// One to one: bones of the same name that hang on bones of the same name, where most of the names that both
/// rigs have agree so; of the others the cheapest pairs, but for bones with too little in common. Names that
/// programs number ("bone 2") tell nothing. costs: bone_costs() of these rigs.
BoneMatches match_bones(const Eigen::MatrixXd& costs, const Rig& source, const Rig& target);

/// [J] each bone's nearest one with a partner along the target's tree, itself first, then towards the root.
std::vector<int> led_by(const Rig& target, const BoneMatches& matches);

}  // namespace understudy
