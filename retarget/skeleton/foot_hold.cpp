#include "retarget/skeleton/foot_hold.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "retarget/base/index.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

constexpr float kEase_s = 0.15f;    // in which a foot comes to where it stands
constexpr float kSlow = 0.4f;       // m/s, of a foot that stands, leg 0.8 m
constexpr float kMostMoved = 0.3f;  // of a foot that stands, share of the leg

/// How high the ball of a foot is at least that moves at `speed` m/s along the floor, metres, leg 0.8 m: in
/// 200 captured clips one in twenty is lower.
float clearance(float speed) {
  return 0.02f + 0.045f * (1 - std::exp(-speed));
}

/// One foot in frames first .. last.
class HeldFoot {
 public:
  HeldFoot(const Joints& rest, int side, int first, int last, Motion& motion)
      : rest_(rest), side_(side), first_(first), last_(last), motion_(motion), offset_(motion.poses.size()) {
    std::fill(offset_.begin(), offset_.end(), Vec3(Vec3::Zero()));
    for (const Pose& pose : motion.poses)
      ball_.push_back(forward_kinematics(rest, pose).joints.row(Leg::of(side).ball).transpose());
  }

  void hold() {
    for (int t = first_; t <= last_; ++t)
      if (stands(t)) t = hold_from(t);
    ease();
    clear_floor();
    for (int t = first_; t <= last_; ++t) move(t);
  }

 private:
  bool stands(int t) const { return motion_.standing[t][side_]; }

  /// Of the frames from `begin` on in which it stands; returns the last of them.
  int hold_from(int begin) {
    int end = begin;
    while (end < last_ && stands(end + 1)) ++end;
    const Vec3* before = begin == first_ ? place_beside(begin, begin - 1) : nullptr;
    const Vec3* after = end == last_ ? place_beside(end, end + 1) : nullptr;
    Vec3 mean = Vec3::Zero();
    for (int t = begin; t <= end; ++t) mean += ball_[t] / static_cast<float>(end - begin + 1);
    const Vec3 from = before ? *before : after ? *after : mean, to = after ? *after : from;
    float most = (to - from).norm() / 2;
    for (int t = begin; t <= end; ++t) {
      const float share = static_cast<float>(t - begin + 1) / static_cast<float>(end - begin + 2);
      offset_[t] = from + share * (to - from) - ball_[t];
      most = std::max(most, offset_[t].norm());
      if (!before && !after) offset_[t] *= freedom(t);
    }
    if (most > kMostMoved * leg_length(rest_))
      for (int t = begin; t <= end; ++t) motion_.standing[t][side_] = false, offset_[t] = Vec3::Zero();
    return end;
  }

  /// Where it is in the frame beside, where it stands there, too; null: it is on its way, or there is none.
  const Vec3* place_beside(int t, int beside) const {
    const Vec3* there = at_or_null(ball_, beside);
    const float slow = kSlow * leg_length(rest_) / 0.8f / motion_.fps;
    return there && (*there - ball_[t]).norm() < slow ? there : nullptr;
  }

  /// 0 beside the frames that stay as they are, 1 far from them.
  float freedom(int t) const {
    const int count = ssize(ball_);
    const int edge = std::min(first_ > 0 ? t - first_ + 1 : count, last_ + 1 < count ? last_ + 1 - t : count);
    const float half = 0.5f * static_cast<float>(last_ - first_ + 2);
    return smooth_step(0, std::min(ease_frames(), half), static_cast<float>(edge));
  }
  float ease_frames() const { return std::max(1.0f, kEase_s * motion_.fps); }

  /// A frame on the way to a stance follows it, and is free at the ends of what may change.
  void ease() {
    const auto share = [this](int frames) {
      return 1 - smooth_step(0, ease_frames(), static_cast<float>(frames));
    };
    std::vector<Vec3> eased = offset_;
    for (int t = first_; t <= last_; ++t) {
      if (stands(t)) continue;
      int since = t - 1, until = t + 1;
      while (since >= first_ && !stands(since)) --since;
      while (until <= last_ && !stands(until)) ++until;
      eased[t].setZero();
      if (since >= first_) eased[t] += share(t - since) * offset_[since];
      if (until <= last_) eased[t] += share(until - t) * offset_[until];
      eased[t] *= freedom(t);
    }
    offset_ = eased;
  }

  /// A foot that swings does so above the floor.
  void clear_floor() {
    std::vector<float> lift(offset_.size(), 0.0f);
    const float scale = leg_length(rest_) / 0.8f;
    const int count = ssize(ball_);
    for (int t = first_; t <= last_; ++t) {
      const int next = std::min(t + 1, count - 1), last = std::max(0, t - 1);
      if (stands(t) || next == last) continue;
      const Vec3 way =
          (ball_[next] + offset_[next] - ball_[last] - offset_[last]) / static_cast<float>(next - last);
      const float speed = Vec3(way.x(), 0, way.z()).norm() * motion_.fps / scale;
      lift[t] = freedom(t) * std::max(0.0f, scale * clearance(speed) - ball_[t].y() - offset_[t].y());
    }
    for (int t = first_; t <= last_; ++t) {  // a foot has no kinks
      const int next = std::min(t + 1, count - 1), last = std::max(0, t - 1);
      if (!stands(t)) offset_[t].y() += 0.25f * (lift[last] + 2 * lift[t] + lift[next]);
    }
  }

  void move(int t) {
    if (offset_[t].isZero(0)) return;
    const Vec3 ankle =
        forward_kinematics(rest_, motion_.poses[t]).joints.row(Leg::of(side_).ankle).transpose();
    place_ankle(rest_, side_, ankle + offset_[t], motion_.poses[t]);
  }

  const Joints& rest_;
  int side_, first_, last_;
  Motion& motion_;
  std::vector<Vec3> ball_, offset_;
};

}  // namespace

void hold_standing(const Joints& rest, int first, int last, Motion& motion) {
  for (int side = 0; side < 2; ++side) HeldFoot(rest, side, first, last, motion).hold();
}

}  // namespace understudy
