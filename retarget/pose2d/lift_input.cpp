#include "retarget/pose2d/lift_input.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/proportions.hpp"

namespace understudy {
namespace {

constexpr int kFewestLifted = 3;
constexpr float kLiftSizeMemory_s = 2;           // a body seems small for a while, never large
constexpr float kLiftRate = 30, kWayScale = 10;  // ways are those of a frame at 30 frames/s
constexpr float kLeastLiftSize = 1e-3f;          // pixels
constexpr float kTrunkOfNeck = 2.5f, kTrunkOfShoulders = 1.5f,
                kGuessed = 0.1f;  // a trunk's length; confidence

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

LiftFrame LiftInput::push(const FlatPose& seen, float dt) {
  US_CHECK(dt > 0, "the time between two poses must be above 0, not ", dt, " s");
  FlatPose pose = seen;
  add_middles(pose);
  const auto points = (pose.body.col(2).head<kPaperPoints>().array() > 0).count();
  US_CHECK(points >= kFewestLifted, "a pose of ", points, " points cannot be lifted: it needs ",
           kFewestLifted);
  US_CHECK(pose.body.allFinite(), "a pose has points that are not finite");
  const bool sees_hips = pose.has(body25::MidHip);
  if (sees_hips && pose.has(body25::Neck)) trunk_ = pose.at(body25::MidHip) - pose.at(body25::Neck);
  if (!sees_hips) guess_hips(pose);
  const float now = size_of(pose);
  US_CHECK(std::isfinite(now) && now > kLeastLiftSize,
           "a pose whose points are all in one place cannot be lifted");
  const float share = now > size_ ? 0.5f : 1 - std::exp(-dt / kLiftSizeMemory_s);
  size_ = has_last_ ? size_ + share * (now - size_) : now;

  LiftFrame frame;
  frame.size = size_;
  frame.sees_hips = sees_hips;
  frame.has_hips = pose.has(body25::MidHip);
  frame.origin = frame.has_hips ? pose.at(body25::MidHip) : Vec2(box_of(pose).center());
  frame.numbers.setZero();
  const Vec2 up(1, -1);
  const bool has_way = has_last_ && had_hips_ == frame.has_hips;
  const float a_frame = kWayScale / (size_ * kLiftRate * dt);
  for (int p = 0; p < kBodyPoints; ++p) {
    if (!pose.has(p)) continue;
    const Vec2 place = pose.at(p) - frame.origin;
    auto numbers = frame.numbers.segment<kLiftPointInputs>(kLiftPointInputs * p);
    numbers.head<2>() = (kLiftPlaceScale / size_ * place.cwiseProduct(up)).transpose();
    numbers.segment<2>(2) << 1, std::min(pose.confidence(p), 1.0f);
    if (!has_way || !last_.has(p)) continue;
    const Vec2 way = place - (last_.at(p) - last_origin_);
    numbers.tail<2>() = (a_frame * way.cwiseProduct(up)).cwiseMax(-5).cwiseMin(5).transpose();
  }
  const Vec2 way = has_way ? Vec2(frame.origin - last_origin_) : Vec2(Vec2::Zero());
  frame.numbers.tail<5>() << 3 * std::log(now / size_),
      (a_frame * way.cwiseProduct(up)).cwiseMax(-5).cwiseMin(5).transpose(),
      std::clamp(kLiftRate * dt, 0.25f, 4.0f), frame.has_hips ? 1 : 0;
  last_ = pose;
  last_origin_ = frame.origin;
  had_hips_ = frame.has_hips;
  has_last_ = true;
  return frame;
}

}  // namespace understudy
