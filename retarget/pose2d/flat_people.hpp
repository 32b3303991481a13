// Simulated people in pictures: what networks learn from that see 2D poses, and what they are judged on.
#pragma once

#include <array>

#include "retarget/base/rng.hpp"
#include "retarget/geometry/pinhole.hpp"
#include "retarget/keypoints/proportions.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Nose, right eye, left eye, right ear, left ear, metres.
using HeadPlaces = Eigen::Matrix<float, 5, 3, Eigen::RowMajor>;
using HeadVertices = std::array<int, 5>;

/// Which vertices of a body in T-pose those are: the nose is the foremost of the head, the ears lie farthest
/// out, the eyes between. Throws Error when nothing is above the head's joint.
HeadVertices head_vertices(const Points& vertices, const Joints& rest);

/// Somebody in T-pose, facing +z.
struct FlatPerson {
  Joints rest;
  HeadPlaces head;  ///< where the head's points are in T-pose
};
FlatPerson flat_person(const Points& vertices, const Joints& rest, const HeadVertices& head);
/// `share` of b, the rest of a.
FlatPerson between(const FlatPerson& a, const FlatPerson& b, float share);

/// How many times as long bones are. Both sides are alike.
struct BoneScales {
  float legs = 1, arms = 1, trunk = 1, head = 1;  ///< head: with the neck
  float shoulders = 1, hips = 1;                  ///< across the body
  float size = 1;                                 ///< of everything
};
/// legs 0.55 to 1.35, arms 0.65 to 1.45, trunk 0.7 to 1.35, head 0.7 to 1.8, shoulders and hips 0.7 to 1.4,
/// size 0.8 to 1.15, evenly.
BoneScales random_scales(Rng& rng);
/// Every bone of kFlatBones becomes exactly so many times as long, the feet with the legs.
FlatPerson scaled_apart(const FlatPerson& person, const BoneScales& scales);

/// The lengths of kFlatBones in T-pose, metres.
BoneLengths lengths_of(const FlatPerson& person);

struct ViewRange {
  float pitch = kPi / 9;             ///< most, up and down; radians
  float nearest = 3, farthest = 10;  ///< metres from the target
  float orthographic = 0.25f;        ///< share of the views
  float share = 0.7f;        ///< of the picture's height, that a metre and a half across the view takes
  Vec2 canvas = {720, 720};  ///< pixels
};
/// From any side, the target in the middle of the canvas.
Pinhole random_view(const Vec3& target, const ViewRange& range, Rng& rng);

/// A person as a camera sees them.
struct FlatSight {
  FlatPose pose;       ///< all 25 points, of confidence 1
  BoneLengths length;  ///< true ones, pixels, as a bone looks that lies across the view beside the mid-hip
  float pixels_a_metre = 1;  ///< there
  float facing = 1;          ///< cosine between where the head faces and the way to the camera
};
/// The nose and what is beside it go with the head, toes and heels with the feet; neck and mid-hip are the
/// middles of shoulders and hips. Throws Error when a point lies less than 0.1 m before a camera that is not
/// orthographic.
FlatSight seen_flat(const FlatPerson& person, const Pose& pose, const Pinhole& camera);

/// Where the picture ends.
enum class Cut { Nowhere, Knees, Hips };

/// What detectors do wrong; none of it as it stands.
struct DetectorErrors {
  float jitter = 0;         ///< of kPointDeviation, each point by itself
  float jitter_m = 0;       ///< standard deviation of each coordinate, metres across the view
  float missing = 0;        ///< share of points that are missing
  float limbs_missing = 0;  ///< share of limbs: an arm from the elbow on, a leg from the knee on
  float exchanged = 0;      ///< share of arms, of legs and of heads whose sides are exchanged
  float astray = 0;         ///< share of points that are seen somewhere near, a limb away
  bool hides_face = false;  ///< nose and eyes are missing where the head faces away
  Cut cut = Cut::Nowhere;   ///< nothing is seen below hips or knees
  enum class Confidence { Certain, Honest, Wrong } confidence = Confidence::Certain;
};
/// Those of a detector on a picture, for learning: often few, sometimes many.
DetectorErrors random_errors(Rng& rng);
/// What a detector makes of it. At least four points of the first 15 are left.
FlatPose detected(const FlatSight& sight, const DetectorErrors& errors, Rng& rng);

}  // namespace understudy
