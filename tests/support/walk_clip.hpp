// A clip of somebody who walks, in the layout of tests/support/training_folder.hpp.
#pragma once

#include <string>

#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::test {

/// The built-in walk at 30 frames/s. Its file does not say that it is a walk.
inline Motion write_walk_clip(const std::string& path) {
  const Motion walk = builtin_motion("walk", builtin_joints());
  NpyArray poses, trans, rate;
  for (const Pose& pose : walk.poses) {
    for (const Mat3& R : pose.local)
      for (const float x : Vec3(rotation_to_axis_angle(R))) poses.values.push_back(x);
    trans.values.insert(trans.values.end(), pose.root.begin(), pose.root.end());
  }
  const int64_t frames = ssize(walk.poses);
  poses.shape = {frames, 66}, trans.shape = {frames, 3};
  rate.values = {30};
  write_npz(path, {{"poses", poses}, {"trans", trans}, {"mocap_framerate", rate}});
  return walk;
}

}  // namespace understudy::test
