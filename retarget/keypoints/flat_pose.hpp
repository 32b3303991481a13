// A person in a picture: OpenPose's BODY_25 with confidence; hands and face ride along.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "retarget/math/types.hpp"

namespace understudy {

constexpr int kBodyPoints = 25, kHandPoints = 21, kFacePoints = 70;

/// BODY_25, the first 15 are those of Zheng et al. (Sci China Inf Sci 64:210103). Left is the person's own.
namespace body25 {
enum Point : int {
  Nose,
  Neck,
  RightShoulder,
  RightElbow,
  RightWrist,
  LeftShoulder,
  LeftElbow,
  LeftWrist,
  MidHip,
  RightHip,
  RightKnee,
  RightAnkle,
  LeftHip,
  LeftKnee,
  LeftAnkle,
  RightEye,
  LeftEye,
  RightEar,
  LeftEar,
  LeftBigToe,
  LeftSmallToe,
  LeftHeel,
  RightBigToe,
  RightSmallToe,
  RightHeel
};
}  // namespace body25

extern const std::array<const char*, kBodyPoints> kBodyPointNames;  ///< "right_shoulder"
/// The number of a point named as in kBodyPointNames, -1 for another name.
int body_point_named(std::string_view name);
/// The point on the other side; its own number for nose, neck and mid-hip.
constexpr std::array<int, kBodyPoints> kBodyMirror = {0,  1,  5,  6,  7,  2,  3,  4,  8,  12, 13, 14, 9,
                                                      10, 11, 16, 15, 18, 17, 22, 23, 24, 19, 20, 21};

using Vec2 = Eigen::Vector2f;
using FlatBox = Eigen::AlignedBox2f;  ///< pixels
/// A row a point, [N, 3]: x to the right and y down in pixels, the middle of the canvas's first pixel at 0, 0
/// as in OpenPose's and COCO's files; then the confidence, above 0 to 1. A row of zeros: the point is
/// missing, which is never a place.
using FlatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using BodyPoints = Eigen::Matrix<float, kBodyPoints, 3, Eigen::RowMajor>;

/// One person in one frame. Every row is finite, and either all zeros or of a confidence above 0.
struct FlatPose {
  BodyPoints body = BodyPoints::Zero();
  FlatPoints left_hand, right_hand;  ///< OpenPose's 21 from the wrist to the little finger's tip, or no rows
  FlatPoints face;                   ///< OpenPose's 70 (68 and the pupils), or no rows

  bool has(int point) const { return body(point, 2) > 0; }
  Vec2 at(int point) const { return body.row(point).head<2>(); }
  float confidence(int point) const { return body(point, 2); }
  void set(int point, const Vec2& place, float confidence) {
    body.row(point) << place.x(), place.y(), confidence;
  }
  void forget(int point) { body.row(point).setZero(); }
};

bool operator==(const FlatPose& a, const FlatPose& b);
inline bool operator!=(const FlatPose& a, const FlatPose& b) {
  return !(a == b);
}

/// How many of the 25 are not missing.
int points_seen(const FlatPose& pose);
/// Whether nothing is seen, neither body nor hands nor face.
bool is_nobody(const FlatPose& pose);
/// Around the points of the body that are seen; empty when none is.
FlatBox box_of(const FlatPose& pose);
/// How large the person is in the picture, pixels: the longer of the box's diagonal and three times the
/// trunk (middle of the shoulders to middle of the hips), so that a bent or half-seen body counts as whole
/// as it can. 0 when fewer than two points are seen.
float size_of(const FlatPose& pose);
/// Left and right exchanged, hands with the arms; places stay. The face is not of two sides.
FlatPose sides_exchanged(const FlatPose& pose);
/// The person in a mirror, about x = 0.
FlatPose in_mirror(const FlatPose& pose);
/// Neck from the shoulders and mid-hip from the hips where they are missing and both of those are seen: the
/// middle, with the lower confidence.
void add_middles(FlatPose& pose);

}  // namespace understudy
