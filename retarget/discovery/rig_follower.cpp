#include "retarget/discovery/rig_follower.hpp"

#include <cmath>
#include <utility>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kFollowedPoints = 2000;
constexpr uint64_t kFollowerSeed = 20240611;

/// As the bones moved last, they go on, a little slower.
BoneMotions led_on(const Rig& rig, const BoneMotions& before, const BoneMotions& last) {
  constexpr float kKept = 0.8f;
  BoneMotions next(last.size());
  for (size_t b = 0; b < last.size(); ++b) {
    const Vec3 rest = rig.joints[b].rest;
    const Vec3 turn = rotation_to_axis_angle(last[b].R * before[b].R.transpose());
    const Vec3 at = last[b](rest) + kKept * (last[b](rest) - before[b](rest));
    next[b].R = rotation_from_axis_angle(kKept * turn) * last[b].R;
    next[b].t = at - next[b].R * rest;
  }
  return next;
}

}  // namespace

RigFollower::RigFollower(const Rig& rig) : rig_(rig) {
  const ThinnedFrame thin = thinned(rig.surface, kFollowedPoints, kFollowerSeed);
  surface_ = {thin.points, thin.normals,
              weights_between(thin.points, rig.surface.vertices, rig.skin, rig.count())};
  // As a surface of so many points has them side by side.
  std::vector<PointTree::Near> near;
  double sum = 0;
  for (Eigen::Index i = 0; i < thin.points.rows(); ++i) {
    thin.tree.nearest(thin.points.row(i).transpose(), 2, near);
    sum += std::sqrt(near.back().squared);
  }
  spacing_m_ = static_cast<float>(sum / static_cast<double>(thin.points.rows()));
  start_from(rest_pose(rig_));
}

void RigFollower::start_from(const RigPose& pose) {
  last_ = before_ = bone_motions(rig_, pose);
}

RigFollower::Followed RigFollower::follow(const Mesh& scan) {
  Followed followed =
      fit(thinned(scan, kFollowedPoints, kFollowerSeed), led_on(rig_, before_, last_));
  before_ = std::exchange(last_, bone_motions(rig_, followed.pose));
  return followed;
}

RigFollower::Followed RigFollower::fit(const Mesh& scan, const RigPose& near) const {
  return fit(thinned(scan, kFollowedPoints, kFollowerSeed), bone_motions(rig_, near));
}

RigFollower::Followed RigFollower::fit(const ThinnedFrame& scan, BoneMotions bones) const {
  ArticulatedFitOptions options;
  options.first_radius_m = 2.5f * spacing_m_;
  options.last_radius_m = 0.8f * spacing_m_;
  options.joint_stiffness = kRigidJoints;
  fit_bones(rig_, surface_, scan, options, bones);
  Followed followed{pose_of(rig_, bones), 0};
  followed.off_m = distances_to(scan, surface_, bone_motions(rig_, followed.pose)).mean();
  return followed;
}

}  // namespace understudy
