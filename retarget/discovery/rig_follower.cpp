#include "retarget/discovery/rig_follower.hpp"

#include <cmath>
#include <utility>

namespace understudy {
namespace {

constexpr int kFollowedPoints = 2000, kFollowedSurface = 6000;
constexpr uint64_t kFollowerSeed = 20240611;

}  // namespace

RigFollower::RigFollower(const Rig& rig) : rig_(rig) {
  const ThinnedFrame thin = thinned(rig.surface, kFollowedPoints, kFollowedPoints, kFollowerSeed);
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

ThinnedFrame RigFollower::seen(const Mesh& scan) {
  return thinned(scan, kFollowedPoints, kFollowedSurface, kFollowerSeed);
}

RigFollower::Followed RigFollower::follow(const Mesh& scan) {
  Followed followed = fit(seen(scan), led_on(before_, last_, rig_.rest_joints()));
  before_ = std::exchange(last_, bone_motions(rig_, followed.pose));
  return followed;
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
