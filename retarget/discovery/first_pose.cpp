#include "retarget/discovery/first_pose.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/discovery/articulated_fit.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kFirstPoints = 1200, kFirstRough = 200, kFirstPoses = 12, kFirstHeadings = 12, kFirstTried = 4;
constexpr uint64_t kFirstSeed = 20240619;

struct FirstGuess {
  BoneMotions bones;
  double cost;
};

/// Mean distance of a few points of both, both ways; what is far counts little.
double rough_distance(const Points& posed, const ThinnedFrame& scan, float size) {
  const PointTree tree(posed);
  const auto off = [&](float squared) {
    return static_cast<double>(std::min(std::sqrt(squared), 0.15f * size));
  };
  double sum = 0;
  for (Eigen::Index i = 0; i < posed.rows(); ++i)
    sum += off(scan.tree.nearest(posed.row(i).transpose()).squared);
  const int few = std::min(kFirstRough, scan.spread);
  for (int q = 0; q < few; ++q)
    sum +=
        off(tree.nearest(scan.points.row(q).transpose()).squared) * static_cast<double>(posed.rows()) / few;
  return sum / (2 * static_cast<double>(posed.rows()));
}

std::vector<FirstGuess> guesses(const RiggedMotion& known, const FittedSurface& surface,
                                const ThinnedFrame& scan) {
  FittedSurface rough = surface;
  const auto few = std::min<Eigen::Index>(kFirstRough, surface.points.rows());
  rough.points.conservativeResize(few, 3);
  rough.skin.bones.conservativeResize(few, Eigen::NoChange);
  rough.skin.weights.conservativeResize(few, Eigen::NoChange);
  const float size = box_diagonal(scan.points);
  const Vec3 there = scan.points.topRows(scan.spread).colwise().mean().transpose();
  std::vector<RigPose> poses{rest_pose(known.rig)};
  const int frames = static_cast<int>(ssize(known.motion.poses)), count = std::min(kFirstPoses, frames);
  for (int i = 0; i < count; ++i)
    poses.push_back(known.motion.poses[static_cast<size_t>(i * (frames - 1) / std::max(1, count - 1))]);
  std::vector<FirstGuess> found;
  for (const RigPose& pose : poses) {
    const BoneMotions bones = bone_motions(known.rig, pose);
    const Vec3 here = skinned(surface.points, surface.skin, bones).colwise().mean().transpose();
    for (int i = 0; i < kFirstHeadings; ++i) {
      RigidMotion turned;
      turned.R = rotation_about_y(2 * kPi * static_cast<float>(i) / kFirstHeadings);
      turned.t = there - turned.R * here;
      FirstGuess guess{bones, 0};
      for (RigidMotion& bone : guess.bones) bone = turned * bone;
      guess.cost = rough_distance(skinned(rough.points, rough.skin, guess.bones), scan, size);
      found.push_back(std::move(guess));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return found;
}

}  // namespace

RigPose first_pose(const RiggedMotion& known, const Mesh& scan) {
  const ThinnedFrame thin = thinned(known.rig.surface, kFirstPoints, kFirstPoints, kFirstSeed),
                     seen = thinned(scan, kFirstPoints, 3 * kFirstPoints, kFirstSeed);
  const FittedSurface surface{
      thin.points, thin.normals,
      weights_between(thin.points, known.rig.surface.vertices, known.rig.skin, known.rig.count())};
  std::vector<FirstGuess> tried = guesses(known, surface, seen);
  tried.resize(std::min<size_t>(tried.size(), kFirstTried));
  const float size = box_diagonal(thin.points);
  ArticulatedFitOptions fit;
  fit.first_radius_m = 0.1f * size;
  fit.last_radius_m = 0.015f * size;
  fit.joint_stiffness = kRigidJoints;
  fit.rounds = 15;
  for (FirstGuess& guess : tried) {
    fit_bones(known.rig, surface, seen, fit, guess.bones);
    guess.cost = rough_distance(skinned(surface.points, surface.skin, guess.bones), seen, size);
  }
  const auto best = std::min_element(tried.begin(), tried.end(),
                                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return pose_of(known.rig, best->bones);
}

}  // namespace understudy
