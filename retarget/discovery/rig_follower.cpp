#include "retarget/discovery/rig_follower.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy {
namespace {

constexpr int kFollowedPoints = 2000;  // of the rig's surface
constexpr int kScanPoints = 6000, kScanSpread = 2000;
constexpr uint64_t kFollowerSeed = 20240611;

/// Some points of a scan, evenly in its own order, as soon as can be; their normals point as the surface that
/// is expected near them does.
ThinnedFrame quickly_thinned(const Mesh& scan, const FittedSurface& surface, const BoneMotions& expected) {
  const Points all = finite_points(scan.vertices);
  US_CHECK(all.rows() >= 30, "a scan of ", all.rows(), " points is too few to follow a rig in");
  const auto count = std::min<Eigen::Index>(kScanPoints, all.rows());
  // Numbers far from each other in turn: the first ones are spread over the whole scan.
  Eigen::Index step = static_cast<Eigen::Index>(0.618 * static_cast<double>(all.rows())) | 1;
  while (std::gcd(step, all.rows()) != 1) ++step;
  Points points(count, 3);
  for (Eigen::Index i = 0, at = 0; i < count; ++i, at = (at + step) % all.rows()) points.row(i) = all.row(at);
  Points normals = estimated_normals(points);
  const PointTree posed(skinned(surface.points, surface.skin, expected));
  const Points outwards = posed_normals(surface, expected);
  for (Eigen::Index i = 0; i < count; ++i)
    if (normals.row(i).dot(outwards.row(posed.nearest(points.row(i).transpose()).point)) < 0)
      normals.row(i) *= -1;
  return {points, normals, static_cast<int>(std::min<Eigen::Index>(kScanSpread, count)), PointTree(points)};
}

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
  return thinned(scan, kScanSpread, kScanPoints, kFollowerSeed);
}

RigFollower::Followed RigFollower::follow(const Mesh& scan) {
  const BoneMotions expected = led_on(before_, last_, rig_.rest_joints());
  Followed followed = fit(scan.is_cloud() ? quickly_thinned(scan, surface_, expected) : seen(scan), expected);
  before_ = std::exchange(last_, bone_motions(rig_, followed.pose));
  return followed;
}

RigFollower::Followed RigFollower::fit(const ThinnedFrame& scan, BoneMotions bones) const {
  ArticulatedFitOptions options;
  options.first_radius_m = 2.5f * spacing_m_;
  options.last_radius_m = 0.8f * spacing_m_;
  options.joint_stiffness = kRigidJoints;
  fit_bones(rig_, surface_, scan, options, bones);
  Followed followed{pose_of(rig_, bones), {}};
  followed.distances = distances_to(scan, surface_, bone_motions(rig_, followed.pose));
  return followed;
}

}  // namespace understudy
