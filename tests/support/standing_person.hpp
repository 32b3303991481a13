// The built-in person as a labelled cloud.
#pragma once

#include <algorithm>

#include "retarget/body/builtin_person.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy::fixtures {

/// In T-pose, every vertex a point.
struct StandingPerson {
  PosedSkeleton truth;
  LabelledPoints cloud;

  StandingPerson() {
    const ShapedBody body = builtin_person();
    truth.joints = body.joints;
    truth.global = identity_rotations();
    cloud.points = body.vertices;
    cloud.parts = nearest_parts(cloud.points, truth.joints);
  }
  float leg() const { return leg_length(truth.joints); }
  Vec3 joint(int j) const { return truth.joints.row(j).transpose(); }
};

inline int count_of(const LabelledPoints& cloud, int part) {
  return static_cast<int>(std::count(cloud.parts.begin(), cloud.parts.end(), part));
}

}  // namespace understudy::fixtures
