#include "retarget/pose2d/lifted_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pose2d/lift_truth.hpp"

namespace understudy {
namespace {

constexpr float kStatureMemory_s =
    0.6f;  // depth comes from it: slower than anybody walks, faster than it seems
constexpr float kSink_s = 0.1f,
                kRise_s = 2;     // the floor goes down with a foot at once, and up after jumps only
constexpr float kSole = 0.012f;  // of the stature, below the ball of the foot
constexpr float kLeastStature_m = 0.3f, kMostStature_m = 3, kMostPitch_deg = 80;

/// The points that show a joint, any of them; none for joints inside the trunk.
std::array<int, 5> points_of(int joint) {
  switch (joint) {
    case LeftHip:
      return {body25::LeftHip, -1, -1, -1, -1};
    case RightHip:
      return {body25::RightHip, -1, -1, -1, -1};
    case LeftKnee:
      return {body25::LeftKnee, -1, -1, -1, -1};
    case RightKnee:
      return {body25::RightKnee, -1, -1, -1, -1};
    case LeftAnkle:
      return {body25::LeftAnkle, -1, -1, -1, -1};
    case RightAnkle:
      return {body25::RightAnkle, -1, -1, -1, -1};
    case LeftFoot:
      return {body25::LeftAnkle, body25::LeftBigToe, body25::LeftHeel, -1, -1};
    case RightFoot:
      return {body25::RightAnkle, body25::RightBigToe, body25::RightHeel, -1, -1};
    case LeftCollar:
    case LeftShoulder:
      return {body25::LeftShoulder, -1, -1, -1, -1};
    case RightCollar:
    case RightShoulder:
      return {body25::RightShoulder, -1, -1, -1, -1};
    case LeftElbow:
      return {body25::LeftElbow, -1, -1, -1, -1};
    case RightElbow:
      return {body25::RightElbow, -1, -1, -1, -1};
    case LeftWrist:
      return {body25::LeftWrist, -1, -1, -1, -1};
    case RightWrist:
      return {body25::RightWrist, -1, -1, -1, -1};
    case Head:
      return {body25::Nose, body25::LeftEye, body25::RightEye, body25::LeftEar, body25::RightEar};
    case Neck:
    case Spine3:
      return {body25::Neck, body25::LeftShoulder, body25::RightShoulder, -1, -1};
    default:
      return {body25::MidHip, body25::LeftHip, body25::RightHip, -1, -1};  // pelvis and lower spine
  }
}

Confidence visibility_of(const FlatPose& pose) {
  Confidence seen;
  for (int j = 0; j < kJointCount; ++j) {
    const auto points = points_of(j);
    seen[j] = std::any_of(points.begin(), points.end(), [&](int p) { return p >= 0 && pose.has(p); }) ? 1 : 0;
  }
  return seen;
}

/// Where the middle of the hips would be seen: the points lie about it as the joints do.
Vec2 hips_of(const LiftedPose& lifted, const FlatPose& pose) {
  if (lifted.has_hips) return lifted.origin;
  Vec2 sum = Vec2::Zero();
  int count = 0;
  for (const int j : {LeftShoulder, RightShoulder, LeftElbow, RightElbow, LeftWrist, RightWrist, LeftKnee,
                      RightKnee, LeftAnkle, RightAnkle, LeftHip, RightHip}) {
    const int point = points_of(j)[0];
    if (!pose.has(point)) continue;
    sum += pose.at(point) - lifted.size * Vec2(lifted.joints(j, 0), -lifted.joints(j, 1));
    ++count;
  }
  return count > 0 ? Vec2(sum / static_cast<float>(count)) : lifted.origin;
}

float chain_of(const Joints& joints) {
  const auto length = bone_lengths(joints);
  const float legs = (length[LeftKnee] + length[RightKnee] + length[LeftAnkle] + length[RightAnkle]) / 2;
  return legs + length[Spine1] + length[Spine2] + length[Spine3] + length[Neck] + length[Head];
}

}  // namespace

float stature_of(const Joints& joints) {
  return chain_of(joints) * (kHumanStature / chain_of(human_rest()));
}

LiftedPath::LiftedPath(const LiftView& view) : view_(view) {
  US_CHECK(view.canvas.is_known(), "2D poses cannot be lifted without the size of their picture");
  US_CHECK(view.stature_m >= kLeastStature_m && view.stature_m <= kMostStature_m,
           "a person's stature must be ", kLeastStature_m, " to ", kMostStature_m, " m, not ",
           view.stature_m);
  US_CHECK(view.fov_deg >= 1 && view.fov_deg <= 170,
           "a camera's field of view must be 1 to 170 degrees, not ", view.fov_deg);
  US_CHECK(!view.pitch_deg || std::abs(*view.pitch_deg) <= kMostPitch_deg, "a camera looks down by ",
           -kMostPitch_deg, " to ", kMostPitch_deg, " degrees, not ", *view.pitch_deg);
  focal_ = static_cast<float>(view.canvas.height) / (2 * std::tan(view.fov_deg * kPi / 360));
}

float LiftedPath::metres_a_pixel(const LiftedPose& lifted, float dt) {
  const float now = std::log(std::max(stature_of(lifted.joints) * lifted.size, 1e-3f));
  const float share = started_ ? 1 - std::exp(-dt / kStatureMemory_s) : 1;
  log_stature_ += share * (now - log_stature_);
  return view_.stature_m / std::exp(log_stature_);
}

/// From the camera's axes to the world's. The camera is still: all poses so far tell how far it looks down.
Mat3 LiftedPath::from_camera(float told) {
  ++poses_;
  pitch_ += (static_cast<double>(std::clamp(told, -1.0f, 1.0f)) - pitch_) / poses_;
  const float pitch = view_.pitch_deg ? *view_.pitch_deg * kPi / 180 : static_cast<float>(std::asin(pitch_));
  return rotation_from_axis_angle(-pitch * Vec3::UnitX());
}

/// Puts the lowest of the body on the floor, at height 0, and lets who jumps jump.
void LiftedPath::stand(Joints& joints, float dt) {
  const float lowest = joints.col(1).minCoeff() - kSole * view_.stature_m;
  const float above = lowest + floor_;
  if (!started_)
    floor_ = -lowest;
  else
    floor_ -= (1 - std::exp(-dt / (above < 0 ? kSink_s : kRise_s))) * above;
  joints.col(1).array() += floor_;
}

Extraction LiftedPath::push(const LiftedPose& lifted, const FlatPose& pose, float dt) {
  const float metres = metres_a_pixel(lifted, dt);
  const Vec2 centre(static_cast<float>(view_.canvas.width) / 2, static_cast<float>(view_.canvas.height) / 2);
  const Vec2 seen = hips_of(lifted, pose) - centre;
  const Vec3 hips = metres * Vec3(seen.x(), -seen.y(), -focal_);  // before the camera
  const Mat3 turn = turn_from_middle(-hips);

  Extraction out;
  if (!started_) first_ = hips;
  const Mat3 world = from_camera(lifted.pitch);
  out.joints = (metres * lifted.size) * lifted.joints * turn.transpose();
  out.joints.rowwise() += (hips - first_).transpose();
  out.joints = (out.joints * world.transpose()).eval();
  stand(out.joints, dt);
  started_ = true;
  for (int j = 0; j < kJointCount; ++j)
    out.confidence[j] = confidence_for(metres * lifted.size * lifted.off[j]);
  out.visibility = visibility_of(pose);
  if (lifted.turns) {
    out.global = *lifted.turns;
    for (Mat3& R : *out.global) R = world * turn * R;
  }
  US_CHECK(out.joints.allFinite() && out.confidence.allFinite(),
           "the network that lifts 2D poses has no finite answer to a pose");
  return out;
}

}  // namespace understudy
