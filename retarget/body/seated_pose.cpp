#include "retarget/body/seated_pose.hpp"

#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {

void sit_down(std::vector<Pose>& poses, Rng& rng) {
  const auto bent = [](float angle) { return rotation_from_axis_angle(Vec3(angle, 0, 0)); };
  const auto turned = [&rng]() -> Mat3 {
    const float angle = 0.15f * rng.normal();
    return rotation_from_axis_angle(angle * random_direction(rng));
  };
  const Mat3 lean = bent(rng.uniform(-0.3f, 0.4f));
  Mat3 hips[2], knees[2];
  for (int side = 0; side < 2; ++side) {
    hips[side] = turned() * bent(rng.uniform(-1.8f, -1.2f));
    knees[side] = turned() * bent(rng.uniform(0.9f, 1.9f));
  }
  for (Pose& pose : poses) {
    pose.local[Pelvis] = rotation_about_y(heading_of(pose.local[Pelvis])) * lean;
    pose.local[LeftHip] = hips[0], pose.local[RightHip] = hips[1];
    pose.local[LeftKnee] = knees[0], pose.local[RightKnee] = knees[1];
  }
}

}  // namespace understudy
