#include "retarget/pose2d/body_view.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

/// How far a feature of the face may turn from the camera before it is gone: the cosine of its own direction,
/// in the head's frame, with the direction to the camera. The tip of the nose is still seen from the side;
/// both ears are from the front and from behind, as detectors find them.
struct FaceSight {
  int point;
  Vec3 towards;  // where it looks, not of unit length
  float least;
};
const std::array<FaceSight, 5> kFaceSights = {{{body25::Nose, {0, 0, 1}, -0.1f},
                                               {body25::RightEye, {-0.5f, 0, 1}, 0.05f},
                                               {body25::LeftEye, {0.5f, 0, 1}, 0.05f},
                                               {body25::RightEar, {-1, 0, 0}, -0.3f},
                                               {body25::LeftEar, {1, 0, 0}, -0.3f}}};

/// What hides a point is nearer by so much, metres, and so many bones away.
constexpr float kBefore = 0.08f;
constexpr int kBonesAway = 3;

Vec3 to_camera(const Pinhole& camera, const Vec3& from) {
  return camera.orthographic ? Vec3(camera.rotation.col(2)) : Vec3((camera.position - from).normalized());
}

bool is_on(const Canvas& canvas, const Vec3& place) {
  if (!canvas.is_known()) return true;
  return place.x() >= -0.5f && place.y() >= -0.5f && place.x() < static_cast<float>(canvas.width) - 0.5f &&
         place.y() < static_cast<float>(canvas.height) - 0.5f;
}

int depth_in_tree(int joint) {
  int depth = 0;
  for (; kParents[joint] >= 0; joint = kParents[joint]) ++depth;
  return depth;
}

int bones_between(int a, int b) {
  int bones = 0;
  for (; a != b; ++bones) {
    int& lower = depth_in_tree(a) >= depth_in_tree(b) ? a : b;
    lower = kParents[lower];
  }
  return bones;
}

void place_face(const PosedSkeleton& posed, const FaceMarks& face, BodyPlaces& places) {
  const Vec3 head = posed.joints.row(Head).transpose();
  const auto put = [&](int point, const Vec3& mark) {
    places.row(point) = (head + posed.global[Head] * mark).transpose();
  };
  put(body25::Nose, face.nose);
  put(body25::RightEye, face.right_eye), put(body25::LeftEye, face.left_eye);
  put(body25::RightEar, face.right_ear), put(body25::LeftEar, face.left_ear);
}

}  // namespace

const std::array<int, kBodyPoints> kJointOfPoint = {
    Head,     Neck,      RightShoulder, RightElbow, RightWrist, LeftShoulder, LeftElbow, LeftWrist, Pelvis,
    RightHip, RightKnee, RightAnkle,    LeftHip,    LeftKnee,   LeftAnkle,    Head,      Head,      Head,
    Head,     LeftFoot,  LeftFoot,      LeftAnkle,  RightFoot,  RightFoot,    RightAnkle};

FootMarks foot_marks(const Joints& rest) {
  FootMarks marks;
  for (const bool is_left : {true, false}) {
    const Vec3 ankle = rest.row(is_left ? LeftAnkle : RightAnkle).transpose();
    const Vec3 ball = rest.row(is_left ? LeftFoot : RightFoot).transpose();
    Vec3 along = ball - ankle;
    const float down = along.y();
    along.y() = 0;
    const Vec3 outwards = (is_left ? 1.0f : -1.0f) * Vec3::UnitY().cross(along);
    Vec3* const mark = marks.data() + (is_left ? 0 : 3);
    mark[0] = 0.6f * along - 0.15f * outwards;        // big toe
    mark[1] = 0.35f * along + 0.3f * outwards;        // small toe
    mark[2] = -0.45f * along + down * Vec3::UnitY();  // heel
  }
  return marks;
}

BodyPlaces places_of_joints(const Joints& joints) {
  BodyPlaces places;
  for (int point = 0; point < kBodyPoints; ++point) places.row(point) = joints.row(kJointOfPoint[point]);
  places.row(body25::Neck) = (joints.row(LeftShoulder) + joints.row(RightShoulder)) / 2;
  places.row(body25::MidHip) = (joints.row(LeftHip) + joints.row(RightHip)) / 2;
  return places;
}

BodyPlaces body_places(const PosedSkeleton& posed, const BodyMarks& marks) {
  BodyPlaces places = places_of_joints(posed.joints);
  place_face(posed, marks.face, places);
  for (int k = 0; k < 6; ++k) {
    const int point = body25::LeftBigToe + k;
    places.row(point) += (posed.global[kJointOfPoint[point]] * marks.feet[k]).transpose();
  }
  return places;
}

FlatPose seen_pose(const BodyPlaces& places, const Mat3& head, const Pinhole& camera,
                   const BodyViewOptions& options) {
  FlatPose pose;
  for (int point = 0; point < kBodyPoints; ++point) {
    const Vec3 seen = camera.project(Vec3(places.row(point).transpose()));
    const bool is_before = seen.z() > 0 || camera.orthographic;
    if (seen.allFinite() && is_before && is_on(options.canvas, seen)) pose.set(point, seen.head<2>(), 1);
  }
  if (!options.hides_face) return pose;
  for (const FaceSight& sight : kFaceSights)
    if (is_turned_away(sight.point, places.row(sight.point).transpose(), head, camera))
      pose.forget(sight.point);
  return pose;
}

bool is_turned_away(int point, const Vec3& place, const Mat3& head, const Pinhole& camera) {
  return std::any_of(kFaceSights.begin(), kFaceSights.end(), [&](const FaceSight& sight) {
    const Vec3 towards = head * sight.towards.normalized();
    return sight.point == point && towards.dot(to_camera(camera, place)) < sight.least;
  });
}

void forget_hidden(FlatPose& pose, const BodyPlaces& places, const Pinhole& camera, const SeenSkin& skin) {
  for (int point = 0; point < kBodyPoints; ++point) {
    if (!pose.has(point)) continue;
    const int x = static_cast<int>(std::lround(pose.at(point).x()));
    const int y = static_cast<int>(std::lround(pose.at(point).y()));
    if (!skin.view.is_inside(x, y)) continue;
    const int face = skin.view.face[skin.view.at(x, y)];
    const float depth = camera.project(Vec3(places.row(point).transpose())).z();
    if (face < 0 || depth - skin.view.depth[skin.view.at(x, y)] < kBefore) continue;
    const int before = skin.joint_of_vertex[static_cast<size_t>(skin.faces(face, 0))];
    if (bones_between(before, kJointOfPoint[point]) >= kBonesAway) pose.forget(point);
  }
}

std::vector<int> joints_of_vertices(const RowMatrix& weights) {
  std::vector<int> joints(static_cast<size_t>(weights.rows()));
  for (Eigen::Index v = 0; v < weights.rows(); ++v) weights.row(v).maxCoeff(&joints[static_cast<size_t>(v)]);
  return joints;
}

}  // namespace understudy
