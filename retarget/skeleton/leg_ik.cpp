#include "retarget/skeleton/leg_ik.hpp"

#include "retarget/skeleton/two_bone_ik.hpp"

namespace understudy {

Vec3 place_ankle(const Joints& rest, int side, const Vec3& ankle, Pose& pose) {
  const Leg leg = Leg::of(side);
  return place_end(rest, {leg.hip, leg.knee, leg.ankle, Vec3::UnitX()}, ankle, pose);
}

}  // namespace understudy
