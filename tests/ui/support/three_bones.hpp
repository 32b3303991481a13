// A found rig, made by hand.
#pragma once

#include <memory>

#include "retarget/discovery/discover.hpp"

namespace understudy::ui {

/// A trunk, a leg on it, a paw on that; 48 frames.
inline std::shared_ptr<const DiscoveredRig> three_bones() {
  auto rig = std::make_shared<DiscoveredRig>();
  understudy::Rig& found = rig->found.rig;
  found.joints = {{"trunk", -1, JointKind::Free, Vec3(0, 1, 0)},
                  {"leg", 0, JointKind::Hinge, Vec3(0, 0.6f, 0), Vec3::UnitX()},
                  {"paw", 1, JointKind::Ball, Vec3(0, 0.2f, 0)}};
  found.surface.vertices = Points::Random(30, 3);
  std::vector<int> bones;
  for (int v = 0; v < 30; ++v) bones.push_back(v < 17 ? 0 : v < 25 ? 1 : 2);
  found.skin = SkinWeights::rigid(bones);
  rig->found.motion.poses.assign(48, rest_pose(found));
  rig->bones = {{0, 0, 0.004f, 1}, {33, 0, 0.006f, 0.5f}, {12, 0, 0.0082f}};
  rig->off_m.assign(48, 0.005f), rig->doubted.assign(48, false);
  rig->off_m[30] = 0.03f, rig->doubted[30] = true;
  return rig;
}

}  // namespace understudy::ui
