// A body laid on another one of its kind, whose proportions are its own.
#pragma once

#include <vector>

#include "retarget/discovery/articulated_fit.hpp"

namespace understudy {

/// What a bone does with what it carries: turned, moved, stretched along its own axis and across it.
struct StretchedBone {
  Mat3 R = Mat3::Identity();
  Vec3 centre = Vec3::Zero(), axis = Vec3::UnitY();  ///< of its points, before
  Vec3 place = Vec3::Zero();                         ///< where the centre goes
  float length = 1, girth = 1;
  Vec3 operator()(const Vec3& x) const { return place + R * stretched(x); }
  /// From the centre, stretched but not turned.
  Vec3 stretched(const Vec3& x) const {
    const Vec3 off = x - centre;
    return girth * off + (length - girth) * axis.dot(off) * axis;
  }
};

/// A body's points as they are posed, and its joints.
struct PosedBody {
  FittedSurface surface;     ///< `points` and `normals` as they are posed
  Points joints;             ///< [J, 3]
  std::vector<int> parents;  ///< [J]
};

struct ProportionFitOptions {
  int rounds = 16;
  float first_radius_m = 0.2f, last_radius_m = 0.04f;  ///< scale of what counts as off, first to last round
};

struct ProportionFit {
  std::vector<StretchedBone> bones;  ///< [J]
  double off_m =
      0;  ///< between both surfaces, both ways, what is far off counting little more than the radius
  double strained =
      0;  ///< mean over bones of how far they are bent against each other (radians) and stretched (logarithm)
  Points points, joints;  ///< where the body's went
};
/// Lays a body that is already about as large, at the place and in the pose of `on`: Gauss-Newton over eight
/// numbers a bone; points come to lie on the other's and theirs on them, joints hold, bones stretch
/// unwillingly.
ProportionFit fit_proportions(const PosedBody& body, const ThinnedFrame& on,
                              const ProportionFitOptions& options);

}  // namespace understudy
