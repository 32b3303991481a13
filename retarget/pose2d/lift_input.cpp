#include "retarget/pose2d/lift_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/seen_points.hpp"

namespace understudy {
namespace {

constexpr int kFewestLifted = 3;
constexpr float kLiftSizeMemory_s = 2;
constexpr float kLiftRate = 30, kWayScale = 10;  // ways are those of a frame at 30 frames/s
constexpr float kLeastLiftSize = 1e-3f;          // pixels
constexpr float kTrunkOfNeck = 2.5f, kTrunkOfShoulders = 1.5f,
                kGuessed = 0.1f;  // a trunk's length; confidence
constexpr float kShareScale = 4, kMostOfLength = 2;
/// Long enough to tell a size by.
constexpr std::array<int, 9> kLongBones = {
    flat_bone::Trunk,        flat_bone::RightUpperArm, flat_bone::LeftUpperArm,
    flat_bone::RightForearm, flat_bone::LeftForearm,   flat_bone::RightThigh,
    flat_bone::LeftThigh,    flat_bone::RightShin,     flat_bone::LeftShin};
const Vec2 kUp(1, -1);

/// Somebody looks small for a while, never large.
float seems(float now, float before, float dt) {
  const float share = now > before ? 0.5f : 1 - std::exp(-dt / kLiftSizeMemory_s);
  return before + share * (now - before);
}

/// Mean of the second to fourth largest of what the long bones tell, as the largest errs; 0: none is seen.
float longest_looking(const BoneLengths& told) {
  std::array<float, kLongBones.size()> sorted;
  std::transform(kLongBones.begin(), kLongBones.end(), sorted.begin(), [&](int bone) { return told[bone]; });
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  float sum = 0;
  int count = 0;
  for (size_t i = 1; i < 4; ++i)
    if (sorted[i] > 0) sum += sorted[i], ++count;
  return count > 0 ? sum / static_cast<float>(count) : sorted[0];
}

}  // namespace

void LiftInput::guess_hips(FlatPose& pose) {
  if (!pose.has(body25::Neck)) return;
  const auto apart = [&](int a, int b) {
    return pose.has(a) && pose.has(b) ? (pose.at(a) - pose.at(b)).norm() : 0;
  };
  const float upright = std::max(kTrunkOfNeck * apart(body25::Nose, body25::Neck),
                                 kTrunkOfShoulders * apart(body25::LeftShoulder, body25::RightShoulder));
  const Vec2 trunk = trunk_.value_or(Vec2(0, upright));
  if (trunk.norm() > kLeastLiftSize) pose.set(body25::MidHip, pose.at(body25::Neck) + trunk, kGuessed);
}

FlatPose liftable(const FlatPose& seen) {
  FlatPose pose = seen_points(seen, kFewestLifted, "cannot be lifted").pose;
  US_CHECK(pose.body.allFinite(), "a pose has points that are not finite");
  return pose;
}

void LiftInput::update_size(const FlatPose& pose, float dt) {
  now_ = size_of(pose);
  US_CHECK(std::isfinite(now_) && now_ > kLeastLiftSize,
           "a pose whose points are all in one place cannot be lifted");
  size_ = has_last_ ? seems(now_, size_, dt) : now_;
}

void LiftInput::put_points(const FlatPose& pose, bool has_way, float a_frame, LiftFrame& frame) const {
  for (int p = 0; p < kBodyPoints; ++p) {
    if (!pose.has(p)) continue;
    const Vec2 place = pose.at(p) - frame.origin;
    auto numbers = frame.numbers.segment<kLiftPointInputs>(kLiftPointInputs * p);
    numbers.head<2>() = (kLiftPlaceScale / size_ * place.cwiseProduct(kUp)).transpose();
    numbers.segment<2>(2) << 1, std::min(pose.confidence(p), 1.0f);
    if (!has_way || !last_.has(p)) continue;
    const Vec2 way = place - (last_.at(p) - last_origin_);
    numbers.tail<2>() = (a_frame * way.cwiseProduct(kUp)).cwiseMax(-5).cwiseMin(5).transpose();
  }
}

/// A bone that looks shorter than it is goes to or from the eye. How large the person would be across the
/// view, the bones tell that look the longest.
void LiftInput::put_bones(const FlatPose& pose, const BoneLengths& lengths, float dt, LiftFrame& frame) {
  const BoneLengths share = lengths / stature_of(lengths), looks = seen_lengths(pose);
  const float now = longest_looking(looks / share);
  if (now > 0) stature_ = stature_ > 0 ? seems(now, stature_, dt) : now;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    auto numbers = frame.numbers.segment<kLiftBoneInputs>(kLiftBonesAt + kLiftBoneInputs * b);
    numbers[2] = kShareScale * share[b];
    if (looks[b] <= 0 || stature_ <= 0) continue;
    const float length = share[b] * stature_, of_length = looks[b] / length;
    const float depth = length * std::sqrt(std::max(0.0f, 1 - of_length * of_length));
    numbers.head<2>() << std::min(of_length, kMostOfLength), kLiftPlaceScale / size_ * depth;
  }
}

LiftFrame LiftInput::push(const FlatPose& seen, const BoneLengths& lengths, float dt) {
  US_CHECK(dt > 0, "the time between two poses must be above 0, not ", dt, " s");
  US_CHECK((lengths > 0).all() && lengths.allFinite(), "a bone's length is not above 0");
  FlatPose pose = liftable(seen);
  const bool sees_hips = pose.has(body25::MidHip);
  if (sees_hips && pose.has(body25::Neck)) trunk_ = pose.at(body25::MidHip) - pose.at(body25::Neck);
  if (!sees_hips) guess_hips(pose);
  update_size(pose, dt);

  LiftFrame frame;
  frame.size = size_;
  frame.sees_hips = sees_hips;
  frame.has_hips = pose.has(body25::MidHip);
  frame.origin = frame.has_hips ? pose.at(body25::MidHip) : Vec2(box_of(pose).center());
  frame.numbers.setZero();
  const bool has_way = has_last_ && had_hips_ == frame.has_hips;
  const float a_frame = kWayScale / (size_ * kLiftRate * dt);
  put_points(pose, has_way, a_frame, frame);
  put_bones(pose, lengths, dt, frame);
  const Vec2 way = has_way ? Vec2(frame.origin - last_origin_) : Vec2(Vec2::Zero());
  frame.numbers.tail<kLiftWholeInputs>() << 3 * std::log(now_ / size_),
      stature_ > 0 ? 3 * std::log(stature_ / size_) : 0,
      (a_frame * way.cwiseProduct(kUp)).cwiseMax(-5).cwiseMin(5).transpose(),
      std::clamp(kLiftRate * dt, 0.25f, 4.0f), frame.has_hips ? 1 : 0;
  last_ = pose;
  last_origin_ = frame.origin;
  had_hips_ = frame.has_hips;
  has_last_ = true;
  return frame;
}

}  // namespace understudy
