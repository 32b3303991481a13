#include "retarget/motion/moving_person.hpp"

namespace understudy {
namespace {

/// Each bone turned back to where the T-pose has it.
Joints rest_of(const Extraction& seen) {
  Joints rest = Joints::Zero();
  for (int j = Pelvis + 1; j < kJointCount; ++j) {
    const int p = kParents[j];
    const Vec3 bone = (seen.joints.row(j) - seen.joints.row(p)).transpose();
    rest.row(j) = rest.row(p) + ((*seen.global)[p].transpose() * bone).transpose();
  }
  return rest;
}

}  // namespace

MovingPerson moving_person(const SkeletalMotion& motion) {
  MovingPerson person;
  person.motion.fps = static_cast<float>(motion.fps());
  for (int64_t t = 0; t < motion.count(); ++t) {
    const Extraction seen = motion.skeleton(t);
    if (t == 0) person.rest = rest_of(seen);
    Pose& pose = person.motion.poses.emplace_back();
    pose.local = local_rotations(*seen.global);
    pose.root = seen.joints.row(Pelvis).transpose();
    person.motion.flags.push_back(seen.joints.allFinite() ? 0 : 1);
  }
  return person;
}

}  // namespace understudy
