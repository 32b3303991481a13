#include "retarget/rig/rig_edits.hpp"

#include "retarget/base/error.hpp"

namespace understudy {

std::vector<int> merge_into_parent(Rig& rig, int joint) {
  US_CHECK(joint > 0 && joint < rig.count(), "joint ", joint, " of ", rig.count(),
           " has no parent to become one with");
  const int parent = rig.joints[static_cast<size_t>(joint)].parent;
  std::vector<int> numbers(rig.joints.size());
  for (int j = 0; j < rig.count(); ++j)
    numbers[static_cast<size_t>(j)] = j == joint ? parent : j > joint ? j - 1 : j;
  rig.joints.erase(rig.joints.begin() + joint);
  for (RigJoint& other : rig.joints)
    if (other.parent >= 0) other.parent = numbers[static_cast<size_t>(other.parent)];
  rig.skin = renumbered(rig.skin, numbers);
  return numbers;
}

SkinWeights renumbered(const SkinWeights& skin, const std::vector<int>& numbers) {
  SkinWeights result = skin;
  for (Eigen::Index v = 0; v < skin.size(); ++v)
    for (int k = 0; k < kSkinBones; ++k) {
      result.bones(v, k) = numbers[static_cast<size_t>(skin.bones(v, k))];
      for (int before = 0; before < k; ++before) {
        if (result.bones(v, before) != result.bones(v, k)) continue;
        result.weights(v, before) += result.weights(v, k);
        result.weights(v, k) = 0;
        break;
      }
    }
  return result;
}

}  // namespace understudy
