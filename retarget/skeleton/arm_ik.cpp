#include "retarget/skeleton/arm_ik.hpp"

#include "retarget/skeleton/two_bone_ik.hpp"

namespace understudy {

Vec3 place_wrist(const Joints& rest, int side, const Vec3& wrist, Pose& pose) {
  const float sign = side == 0 ? 1.0f : -1.0f;  // elbows flex the forearm forward and a little up
  const TwoBones arm{LeftShoulder + side, LeftElbow + side, LeftWrist + side, sign * Vec3(0, -0.87f, 0.49f)};
  return place_end(rest, arm, wrist, pose);
}

}  // namespace understudy
