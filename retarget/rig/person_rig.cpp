#include "retarget/rig/person_rig.hpp"

namespace understudy {

Rig person_rig(const Joints& rest) {
  Rig rig;
  rig.name = "person";
  for (int j = 0; j < kJointCount; ++j)
    rig.joints.push_back({kJointNames[static_cast<size_t>(j)], kParents[static_cast<size_t>(j)],
                          j == 0 ? JointKind::Free : JointKind::Ball, rest.row(j).transpose(),
                          Vec3::UnitY()});
  return rig;
}

RigPose person_pose(const Pose& pose) {
  return {pose.root, {pose.local.begin(), pose.local.end()}, std::vector<float>(kJointCount, 0)};
}

}  // namespace understudy
