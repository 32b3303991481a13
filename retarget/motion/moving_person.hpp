// A skeletal motion as poses of one person: what is coded, cut into steps and blended.
#pragma once

#include "retarget/motion/skeletal_motion.hpp"

namespace understudy {

struct MovingPerson {
  Motion motion;                 ///< as many frames as the file has, at its rate
  Joints rest = Joints::Zero();  ///< T-pose joints, the pelvis at the origin, metres
};

/// Bone lengths are those of the first frame. Motion::flags has the frames whose joints are not finite.
MovingPerson moving_person(const SkeletalMotion& motion);

}  // namespace understudy
