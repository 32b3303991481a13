#include "retarget/pose2d/flat_people.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/exchanged_sides.hpp"
#include "retarget/keypoints/point_deviations.hpp"
#include "retarget/pose2d/body_view.hpp"

namespace understudy {

namespace {

constexpr float kNearestPoint = 0.1f;  // metres before the eye
constexpr int kFirstOfHead[] = {body25::Nose, body25::RightEye, body25::LeftEye, body25::RightEar,
                                body25::LeftEar};

Vec3 row_of(const Joints& joints, int joint) {
  return joints.row(joint).transpose();
}

Vec3 middle(const Joints& joints, int left, int right) {
  return (row_of(joints, left) + row_of(joints, right)) / 2;
}

/// Points of a foot in T-pose: about the ball, and on the sole under the ankle.
struct FootPlaces {
  Vec3 big_toe, small_toe, heel;
};
FootPlaces foot_places(const Joints& rest, int ankle_joint, int foot_joint) {
  const Vec3 ankle = row_of(rest, ankle_joint), ball = row_of(rest, foot_joint);
  const float long_m = std::abs(ball.z() - ankle.z()), out = ball.x() < 0 ? -1.0f : 1.0f;
  return {ball + long_m * Vec3(-0.15f * out, 0, 0.6f), ball + long_m * Vec3(0.4f * out, 0, 0.2f),
          Vec3(ankle.x(), ball.y(), ankle.z() - 0.4f * long_m)};
}

/// A point that goes with a joint.
Vec3 carried(const PosedSkeleton& posed, const Joints& rest, int joint, const Vec3& place) {
  return row_of(posed.joints, joint) +
         posed.global[static_cast<size_t>(joint)] * (place - row_of(rest, joint));
}

/// With a face of its own, and longer toes than body_places has: trained networks know these.
BodyPlaces points_in_space(const FlatPerson& person, const PosedSkeleton& posed) {
  BodyPlaces points = places_of_joints(posed.joints);
  for (int i = 0; i < 5; ++i)
    points.row(kFirstOfHead[i]) =
        carried(posed, person.rest, Head, person.head.row(i).transpose()).transpose();
  for (const bool left : {false, true}) {
    const int ankle = left ? LeftAnkle : RightAnkle, foot = left ? LeftFoot : RightFoot;
    const FootPlaces places = foot_places(person.rest, ankle, foot);
    points.row(left ? body25::LeftBigToe : body25::RightBigToe) =
        carried(posed, person.rest, foot, places.big_toe);
    points.row(left ? body25::LeftSmallToe : body25::RightSmallToe) =
        carried(posed, person.rest, foot, places.small_toe);
    points.row(left ? body25::LeftHeel : body25::RightHeel) = carried(posed, person.rest, ankle, places.heel);
  }
  return points;
}

}  // namespace

HeadVertices head_vertices(const Points& vertices, const Joints& rest) {
  const float from = rest(Head, 1), middle_x = rest(Head, 0);
  int nose = -1, right_ear = -1, left_ear = -1;
  for (int v = 0; v < vertices.rows(); ++v) {
    if (vertices(v, 1) < from) continue;
    if (nose < 0 || vertices(v, 2) > vertices(nose, 2)) nose = v;
    if (right_ear < 0 || vertices(v, 0) < vertices(right_ear, 0)) right_ear = v;
    if (left_ear < 0 || vertices(v, 0) > vertices(left_ear, 0)) left_ear = v;
  }
  US_CHECK(nose >= 0, "a body has no vertex above its head's joint: nobody knows where its nose is");
  const float half = (vertices(left_ear, 0) - vertices(right_ear, 0)) / 2;
  const auto eye = [&](float side) {  // the foremost about there
    const Vec3 about(middle_x + side * 0.35f * half, vertices(nose, 1) + 0.44f * half, vertices(nose, 2));
    int best = nose;
    float least = 1e9f;
    for (int v = 0; v < vertices.rows(); ++v) {
      if (vertices(v, 1) < from) continue;
      const float far = (vertices.row(v).transpose() - about).norm();
      if (far < least) least = far, best = v;
    }
    return best;
  };
  return {nose, eye(-1), eye(1), right_ear, left_ear};
}

FlatPerson flat_person(const Points& vertices, const Joints& rest, const HeadVertices& head) {
  FlatPerson person{rest, {}};
  for (size_t i = 0; i < head.size(); ++i)
    person.head.row(static_cast<Eigen::Index>(i)) = vertices.row(head[i]);
  return person;
}

FlatPerson between(const FlatPerson& a, const FlatPerson& b, float share) {
  return {(1 - share) * a.rest + share * b.rest, (1 - share) * a.head + share * b.head};
}

BoneScales random_scales(Rng& rng) {
  BoneScales scales;
  scales.legs = rng.uniform(0.55f, 1.35f);
  scales.arms = rng.uniform(0.65f, 1.45f);
  scales.trunk = rng.uniform(0.7f, 1.35f);
  scales.head = rng.uniform(0.7f, 1.8f);
  scales.shoulders = rng.uniform(0.7f, 1.4f);
  scales.hips = rng.uniform(0.7f, 1.4f);
  scales.size = rng.uniform(0.8f, 1.15f);
  return scales;
}

FlatPerson scaled_apart(const FlatPerson& person, const BoneScales& scales) {
  const Joints& rest = person.rest;
  Joints scaled = rest * scales.trunk;  // of the trunk's middle, and heights
  const auto hang = [&](int joint, int on, float scale) {
    scaled.row(joint) = scaled.row(on) + scale * (rest.row(joint) - rest.row(on));
  };
  const auto across = [&](int joint, float scale) { scaled(joint, 0) = rest(joint, 0) * scale; };
  for (const int joint : {LeftCollar, RightCollar, LeftShoulder, RightShoulder})
    across(joint, scales.shoulders);
  across(LeftHip, scales.hips), across(RightHip, scales.hips);
  const Vec3 was = middle(rest, LeftShoulder, RightShoulder),
             is = middle(scaled, LeftShoulder, RightShoulder);
  const auto on_neck = [&](const Vec3& place) { return Vec3(is + scales.head * (place - was)); };
  for (const int joint : {Neck, Head}) scaled.row(joint) = on_neck(row_of(rest, joint)).transpose();
  for (const int joint : {LeftElbow, RightElbow, LeftWrist, RightWrist})
    hang(joint, kParents[joint], scales.arms);
  for (const int joint : {LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftFoot, RightFoot})
    hang(joint, kParents[joint], scales.legs);
  FlatPerson result{scaled, {}};
  for (int i = 0; i < 5; ++i) result.head.row(i) = on_neck(person.head.row(i).transpose()).transpose();
  result.rest *= scales.size;
  result.head *= scales.size;
  return result;
}

BoneLengths lengths_of(const FlatPerson& person) {
  Pose rest;
  rest.root = row_of(person.rest, Pelvis);
  const Points points = points_in_space(person, forward_kinematics(person.rest, rest));
  BoneLengths length;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const FlatBone& bone = kFlatBones[static_cast<size_t>(b)];
    length[b] = (points.row(bone.to) - points.row(bone.from)).norm();
  }
  return length;
}

Pinhole random_view(const Vec3& target, const ViewRange& range, Rng& rng) {
  const float yaw = rng.uniform(-kPi, kPi), pitch = rng.uniform(-range.pitch, range.pitch),
              distance = rng.uniform(range.nearest, range.farthest);
  Pinhole camera = looking_at(target, camera_axes(yaw, pitch), distance);
  camera.orthographic = rng.chance(range.orthographic);
  const float a_metre = range.canvas.y() * range.share / 1.5f;
  camera.focal = camera.orthographic ? a_metre : a_metre * distance;
  camera.centre = range.canvas / 2;
  return camera;
}

FlatSight seen_flat(const FlatPerson& person, const Pose& pose, const Pinhole& camera) {
  const PosedSkeleton posed = forward_kinematics(person.rest, pose);
  const Points points = points_in_space(person, posed);
  FlatSight sight;
  for (int p = 0; p < kBodyPoints; ++p) {
    const Vec3 seen = camera.project(Vec3(points.row(p).transpose()));
    US_CHECK(camera.orthographic || seen.z() > kNearestPoint, "a simulated person stands in the camera");
    sight.pose.set(p, seen.head<2>(), 1);
    if (p == body25::MidHip) sight.pixels_a_metre = camera.pixels_a_metre(seen.z());
  }
  sight.length = lengths_of(person) * sight.pixels_a_metre;
  const Vec3 head = row_of(posed.joints, Head);
  const Vec3 to_camera =
      camera.orthographic ? Vec3(camera.rotation.col(2)) : Vec3((camera.position - head).normalized());
  sight.facing = posed.global[Head].col(2).dot(to_camera);
  return sight;
}

namespace {

/// A limb's points, from where it bends on.
constexpr std::array<std::array<int, 5>, 4> kFlatLimbs = {
    {{body25::RightElbow, body25::RightWrist, -1, -1, -1},
     {body25::LeftElbow, body25::LeftWrist, -1, -1, -1},
     {body25::RightKnee, body25::RightAnkle, body25::RightBigToe, body25::RightSmallToe, body25::RightHeel},
     {body25::LeftKnee, body25::LeftAnkle, body25::LeftBigToe, body25::LeftSmallToe, body25::LeftHeel}}};

/// Root of a person's area, pixels, as COCO's deviations are of.
float coco_scale(const FlatPose& pose) {
  const Vec2 size = box_of(pose).sizes();
  return std::sqrt(static_cast<float>(kAreaOfBox) * std::max(size.x(), 0.25f * size.y()) *
                   std::max(size.y(), 0.25f * size.x()));
}

/// Moves the points; how far each is off, of its deviation.
std::array<float, kBodyPoints> move_points(const FlatSight& sight, const DetectorErrors& errors, Rng& rng,
                                           FlatPose& pose) {
  std::array<float, kBodyPoints> off{};
  const float scale = coco_scale(sight.pose), everywhere = errors.jitter_m * sight.pixels_a_metre;
  for (int p = 0; p < kBodyPoints; ++p) {
    const float deviation = scale * static_cast<float>(kPointDeviation[static_cast<size_t>(p)]);
    float spread = std::hypot(errors.jitter * deviation, everywhere);
    if (rng.chance(errors.astray)) spread += 0.25f * scale;
    const float x = rng.normal(), y = rng.normal();
    pose.set(p, pose.at(p) + spread * Vec2(x, y), 1);
    off[static_cast<size_t>(p)] = spread * std::hypot(x, y) / deviation;
  }
  return off;
}

float told_confidence(float off, DetectorErrors::Confidence kind, Rng& rng) {
  if (kind == DetectorErrors::Confidence::Certain) return 1;
  if (kind == DetectorErrors::Confidence::Wrong) return rng.uniform(0.05f, 1);
  return std::clamp(0.9f * std::exp(-0.5f * off * off / 2.25f) + 0.1f * rng.normal(), 0.05f, 1.0f);
}

void exchange_groups(float share, Rng& rng, FlatPose& pose) {
  for (int group = 0; group < ExchangedSides::kGroups; ++group) {
    if (!rng.chance(share)) continue;
    const FlatPose was = pose;
    for (int p = 0; p < kBodyPoints; ++p)
      if (ExchangedSides::is_in_group(p, group))
        pose.body.row(p) = was.body.row(kBodyMirror[static_cast<size_t>(p)]);
  }
}

/// A picture ends at a line: a hand below it is missing, too.
void cut_off(const FlatSight& sight, Cut cut, FlatPose& pose) {
  if (cut == Cut::Nowhere) return;
  const float hips = sight.pose.at(body25::MidHip).y(), trunk = sight.length[flat_bone::Trunk],
              knees = std::max(sight.pose.at(body25::LeftKnee).y(), sight.pose.at(body25::RightKnee).y());
  const float line = (cut == Cut::Hips ? hips : std::max(hips, knees)) + 0.15f * trunk;
  for (int p = 0; p < kBodyPoints; ++p)
    if (pose.at(p).y() > line) pose.forget(p);
}

void lose_points(const FlatSight& sight, const DetectorErrors& errors, Rng& rng, FlatPose& pose) {
  for (const auto& limb : kFlatLimbs)
    if (rng.chance(errors.limbs_missing))
      for (const int p : limb)
        if (p >= 0) pose.forget(p);
  if (errors.hides_face && sight.facing < -0.2f)
    for (const int p : {body25::Nose, body25::RightEye, body25::LeftEye}) pose.forget(p);
  for (int p = 0; p < kBodyPoints; ++p)
    if (rng.chance(errors.missing)) pose.forget(p);
}

}  // namespace

DetectorErrors random_errors(Rng& rng) {
  DetectorErrors errors;
  const auto sometimes = [&](float chance, float most) {
    return rng.chance(chance) ? rng.uniform(0, most) : 0.0f;
  };
  const float quality = rng.uniform();
  errors.jitter = rng.chance(0.3f) ? 0 : 0.6f * quality * quality;
  errors.jitter_m = sometimes(0.3f, 0.03f);
  errors.missing = sometimes(0.3f, 0.25f);
  errors.limbs_missing = sometimes(0.2f, 0.5f);
  errors.exchanged = sometimes(0.15f, 0.3f);
  errors.astray = sometimes(0.15f, 0.1f);
  errors.hides_face = rng.chance(0.3f);
  if (rng.chance(0.12f)) errors.cut = rng.chance(0.5f) ? Cut::Hips : Cut::Knees;
  const float kind = rng.uniform();
  using Confidence = DetectorErrors::Confidence;
  errors.confidence = kind < 0.4f    ? Confidence::Certain
                      : kind < 0.85f ? Confidence::Honest
                                     : Confidence::Wrong;
  return errors;
}

FlatPose detected(const FlatSight& sight, const DetectorErrors& errors, Rng& rng) {
  FlatPose pose = sight.pose;
  const auto off = move_points(sight, errors, rng, pose);
  for (int p = 0; p < kBodyPoints; ++p)
    pose.body(p, 2) = told_confidence(off[static_cast<size_t>(p)], errors.confidence, rng);
  exchange_groups(errors.exchanged, rng, pose);
  const FlatPose whole = pose;
  cut_off(sight, errors.cut, pose);
  lose_points(sight, errors, rng, pose);
  const auto left = (pose.body.col(2).head<15>().array() > 0).count();
  return left >= 4 ? pose : whole;
}

}  // namespace understudy
