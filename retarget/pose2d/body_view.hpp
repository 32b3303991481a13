// A body in space as a detector sees it through a camera: a 2D pose.
#pragma once

#include <vector>

#include "retarget/geometry/surface_view.hpp"
#include "retarget/keypoints/keypoint_track.hpp"
#include "retarget/pose2d/face_marks.hpp"

namespace understudy {

/// The points of BODY_25 in the world, metres.
using BodyPlaces = Eigen::Matrix<float, kBodyPoints, 3, Eigen::RowMajor>;
/// The joint that each point of BODY_25 moves with.
extern const std::array<int, kBodyPoints> kJointOfPoint;

/// Toes and heel of both feet, in the order of BODY_25's from the left big toe: from the foot's joint, that
/// of a heel from the ankle's, in that joint's frame, metres.
using FootMarks = std::array<Vec3, 6>;
/// Of a body of these T-pose joints, from the lengths of its feet.
FootMarks foot_marks(const Joints& rest);

/// What a body has beside its joints.
struct BodyMarks {
  FaceMarks face;
  FootMarks feet;
};

/// Every point at its joint; the neck is the middle of the shoulders, the mid-hip that of the hips.
BodyPlaces places_of_joints(const Joints& joints);
/// With face and feet.
BodyPlaces body_places(const PosedSkeleton& posed, const BodyMarks& marks);

struct BodyViewOptions {
  Canvas canvas;           ///< what lies off it is missing; unknown: nothing is
  bool hides_face = true;  ///< nose, eyes and ears vanish when the head turns them away from the camera
};

/// Whether nose, eye or ear at a place in the world vanishes for a camera, by where the head looks.
bool is_turned_away(int point, const Vec3& place, const Mat3& head, const Pinhole& camera);
/// What is seen is of confidence 1. What is behind the eye is missing.
FlatPose seen_pose(const BodyPlaces& places, const Mat3& head, const Pinhole& camera,
                   const BodyViewOptions& options = {});

/// The skin of the body as the same camera sees it.
struct SeenSkin {
  const SurfaceView& view;
  const Faces& faces;
  const std::vector<int>& joint_of_vertex;  ///< [V], that it follows most
};
/// Forgets the points that another part of the body hides: the surface seen there is nearer by a palm's width
/// and moves with a joint more than two bones away.
void forget_hidden(FlatPose& pose, const BodyPlaces& places, const Pinhole& camera, const SeenSkin& skin);
/// Of skin weights [V, 22].
std::vector<int> joints_of_vertices(const RowMatrix& weights);

}  // namespace understudy
