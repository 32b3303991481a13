// The built-in person walks before a camera: what is seen of it and what is true.
#pragma once

#include <vector>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/lift_truth.hpp"

namespace understudy {

struct LiftedWalk {
  std::vector<FlatPose> poses;
  std::vector<LiftTruth> truth;
  BoneLengths lengths = BoneLengths::Ones();  ///< of the person
  float dt = 1 / 30.0f;
};

/// yaw, pitch: where the camera stands and how far it looks down, radians.
inline LiftedWalk lifted_walk(float yaw, size_t most = 60, float pitch = 0) {
  static const ShapedBody body = builtin_person();
  static const FlatPerson person =
      flat_person(body.vertices, body.joints, head_vertices(body.vertices, body.joints));
  const Motion motion = builtin_motion("walk", body.joints);
  Pinhole camera = looking_at(Vec3(0, 0.9f, 0), camera_axes(yaw, pitch), 8);
  camera.focal = 1500;
  camera.centre = {360, 360};
  LiftedWalk walk;
  walk.dt = 1 / motion.fps;
  walk.lengths = lengths_of(person);
  for (size_t t = 0; t < std::min(most, motion.poses.size()); ++t) {
    walk.poses.push_back(seen_flat(person, motion.poses[t], camera).pose);
    walk.truth.push_back(lift_truth(forward_kinematics(person.rest, motion.poses[t]), camera));
  }
  return walk;
}

}  // namespace understudy
