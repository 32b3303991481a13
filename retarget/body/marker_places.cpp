#include "retarget/body/marker_places.hpp"

#include "retarget/base/error.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {

// Offsets are those of the built-in person and of a mean human body, between both; marker_vertices finds the
// skin.
const std::array<MarkerPlace, kMarkerCount> kMarkerPlaces = {
    {{"forehead", Head, {0, 0.105f, 0.115f}},
     {"back", Spine3, {0, 0.11f, -0.07f}},
     {"left_shoulder", LeftShoulder, {0, 0.067f, 0}},
     {"right_shoulder", RightShoulder, {0, 0.067f, 0}},
     {"left_elbow", LeftElbow, {0, 0, -0.045f}},
     {"right_elbow", RightElbow, {0, 0, -0.045f}},
     {"left_wrist", LeftWrist, {0, 0.022f, 0}},
     {"right_wrist", RightWrist, {0, 0.022f, 0}},
     {"left_hip", Pelvis, {0.14f, 0.077f, 0.118f}},
     {"right_hip", Pelvis, {-0.14f, 0.077f, 0.118f}},
     {"left_knee", LeftKnee, {0, 0, 0.07f}},
     {"right_knee", RightKnee, {0, 0, 0.07f}},
     {"left_ankle", LeftAnkle, {0.048f, -0.008f, 0}},
     {"right_ankle", RightAnkle, {-0.048f, -0.008f, 0}},
     {"left_toe", LeftFoot, {0, 0.022f, 0.04f}},
     {"right_toe", RightFoot, {0, 0.022f, 0.04f}}}};

int marker_named(const std::string& name) {
  for (int m = 0; m < kMarkerCount; ++m)
    if (name == kMarkerPlaces[m].name) return m;
  return -1;
}

MarkerPoints marker_points(const Joints& rest) {
  return marker_points(rest, {identity_rotations(), rest.row(Pelvis).transpose()});
}

MarkerPoints marker_points(const Joints& rest, const Pose& pose) {
  const PosedSkeleton posed = forward_kinematics(rest, pose);
  const float leg = leg_length(rest);
  MarkerPoints points;
  for (int m = 0; m < kMarkerCount; ++m) {
    const MarkerPlace& place = kMarkerPlaces[m];
    const Vec3 offset = leg * Vec3(place.offset[0], place.offset[1], place.offset[2]);
    points.row(m) = posed.joints.row(place.joint) + (posed.global[place.joint] * offset).transpose();
  }
  return points;
}

std::vector<int> marker_vertices(const Points& vertices, const Joints& rest) {
  US_CHECK(vertices.rows() > 0, "markers are put on a surface, and there is none");
  const IntMatrix nearest = nearest_neighbours(vertices, marker_points(rest), 1);
  return {nearest.data(), nearest.data() + nearest.size()};
}

}  // namespace understudy
