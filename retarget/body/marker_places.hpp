// Where markers are put on a body: sixteen standard places that any skeleton tells, and any surface.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// A place on the skin, seen from a joint in T-pose (y up, facing +z). It moves with that joint.
struct MarkerPlace {
  const char* name;  ///< "left_knee", in tables of markers
  Joint joint;
  std::array<float, 3> offset;  ///< in leg lengths, so that it fits bodies of any size
};

constexpr int kMarkerCount = 16;
/// Forehead and back; shoulders, elbows, wrists, hips, knees, ankles and toes.
extern const std::array<MarkerPlace, kMarkerCount> kMarkerPlaces;

/// Its number in kMarkerPlaces, -1 for another name.
int marker_named(const std::string& name);

using MarkerPoints = Eigen::Matrix<float, kMarkerCount, 3, Eigen::RowMajor>;
/// Where they are on somebody in T-pose whose joints are `rest`, as far as the skeleton tells, metres.
MarkerPoints marker_points(const Joints& rest);
/// The same in a pose.
MarkerPoints marker_points(const Joints& rest, const Pose& pose);
/// The vertices nearest to them on a surface in T-pose: what is marked on this body. Throws Error without
/// vertices.
std::vector<int> marker_vertices(const Points& vertices, const Joints& rest);

}  // namespace understudy
