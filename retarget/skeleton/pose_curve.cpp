#include "retarget/skeleton/pose_curve.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

constexpr float kRest_s = 0.15f;  // in which a movement that nothing is known of loses most of its speed
constexpr float kLongest_s = 4;   // that a movement goes on as it was at the ends
constexpr float kFullTurn = 2 * kPi;

/// The rotation vector nearest to `near` of those that mean the same rotation.
Vec3 unwrapped(const Vec3& turn, const Vec3& near) {
  const float angle = turn.norm();
  if (angle < 1e-4f) return turn;
  const Vec3 axis = turn / angle;
  return turn + kFullTurn * std::round((near.dot(axis) - angle) / kFullTurn) * axis;
}

/// The cubic with values 0, b and slopes (per unit of t) u, v at t = 0, 1.
Vec3 hermite(const Vec3& u, const Vec3& b, const Vec3& v, float t) {
  const float t2 = t * t, t3 = t2 * t;
  return (t3 - 2 * t2 + t) * u + (3 * t2 - 2 * t3) * b + (t3 - t2) * v;
}

/// One part of a motion over its frames, as steps from one of them: rotation vectors, or ways in metres.
class PartCurve {
 public:
  PartCurve(const std::vector<KnownParts>& known, int part, Motion& motion)
      : known_(known), part_(part), motion_(motion) {}

  void fill(int first, int last) {
    for (int t = first; t <= last; ++t) {
      if (is_known(t)) continue;
      const int before = known_before(t), after = known_after(t);
      if (before >= 0 && after >= 0)
        fill_between(before, after, first, last);
      else if (before >= 0)
        predict(before, t, last);
      else if (after >= 0)
        predict(after, t, std::min(last, after - 1));
      if (after < 0) return;
      t = after;
    }
  }

 private:
  bool is_known(int t) const { return known_[static_cast<size_t>(t)][static_cast<size_t>(part_)]; }
  int known_before(int t) const {
    do --t;
    while (t >= 0 && !is_known(t));
    return t;
  }
  int known_after(int t) const {
    const int count = ssize(motion_.poses);
    do ++t;
    while (t < count && !is_known(t));
    return t < count ? t : -1;
  }

  /// Frame `to` seen from frame `from`.
  Vec3 step(int from, int to, const Vec3& near = Vec3::Zero()) const {
    const Pose &a = motion_.poses[from], &b = motion_.poses[to];
    if (part_ == kRootPart) return b.root - a.root;
    return unwrapped(rotation_to_axis_angle(a.local[part_].transpose() * b.local[part_]), near);
  }
  void set(int t, const Pose& origin, const Vec3& step) {
    Pose& pose = motion_.poses[t];
    if (part_ == kRootPart)
      pose.root = origin.root + step;
    else
      pose.local[part_] = origin.local[part_] * rotation_from_axis_angle(step);
  }

  /// A frame's step at the known frame between `before` (-1: none) and a way of `on` in `frames` frames.
  Vec3 speed_at(int before, int at, const Vec3& on, float frames) const {
    if (before < 0) return on / frames;
    Vec3 past = -step(at, before);
    const auto since = static_cast<float>(at - before);
    if (at - before == 1) return past;
    return (past / since * frames + on / frames * since) / (since + frames);
  }
  Vec3 speed_coming(int before, int at, int next, const Vec3& way) const {
    const auto frames = static_cast<float>(at - before);
    if (next < 0) return way / frames;
    Vec3 on = step(before, next, way) - way;
    const auto until = static_cast<float>(next - at);
    if (next - at == 1) return on;
    return (on / until * frames + way / frames * until) / (until + frames);
  }

  void fill_between(int before, int after, int first, int last) {
    const auto length = static_cast<float>(after - before);
    const Pose origin = motion_.poses[before];
    const Vec3 end = step(before, after);
    const Vec3 leaving = speed_at(known_before(before), before, end, length);
    const Vec3 coming = speed_coming(before, after, known_after(after), end);
    if (length > kLongest_s * motion_.fps) return rest_between(before, after, first, last, leaving, coming);
    for (int t = std::max(first, before + 1); t <= std::min(last, after - 1); ++t) {
      const float at = static_cast<float>(t - before) / length;
      set(t, origin, hermite(length * leaving, end, length * coming, at));
    }
  }

  /// Comes to rest after the one end, sets out before the other, and goes over slowly between.
  void rest_between(int before, int after, int first, int last, const Vec3& leaving, const Vec3& coming) {
    const Pose origin = motion_.poses[before];
    const Vec3 end = step(before, after);
    const float slowing = kRest_s * motion_.fps;
    const auto gone = [slowing](int frames) {
      return slowing * (1 - std::exp(-static_cast<float>(frames) / slowing));
    };
    for (int t = std::max(first, before + 1); t <= std::min(last, after - 1); ++t) {
      const float over = smooth_step(0, static_cast<float>(after - before), static_cast<float>(t - before));
      set(t, origin, (1 - over) * gone(t - before) * leaving + over * (end - gone(after - t) * coming));
    }
  }

  /// Frames first .. last, all on one side of the known frame `from`.
  void predict(int from, int first, int last) {
    const bool on = first > from;
    const int past = on ? known_before(from) : known_after(from);
    const Pose origin = motion_.poses[from];
    const auto away = static_cast<float>(std::abs(from - past));
    const Vec3 speed = past < 0 ? Vec3(Vec3::Zero()) : Vec3(-step(from, past) / away);
    const float slowing = kRest_s * motion_.fps;  // frames
    for (int t = first; t <= last; ++t)
      set(t, origin, slowing * (1 - std::exp(-static_cast<float>(std::abs(t - from)) / slowing)) * speed);
  }

  const std::vector<KnownParts>& known_;
  int part_;
  Motion& motion_;
};

}  // namespace

Pose between(const Pose& a, const Pose& b, float share) {
  if (share == 0) return a;
  if (share == 1) return b;
  Pose pose;
  pose.root = a.root + share * (b.root - a.root);
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] =
        Eigen::Quaternionf(a.local[j]).slerp(share, Eigen::Quaternionf(b.local[j])).toRotationMatrix();
  return pose;
}

std::vector<KnownDistance> known_distances(const std::vector<KnownParts>& known) {
  const int count = ssize(known);
  std::vector<KnownDistance> distances(known.size());
  for (size_t part = 0; part < kPartCount; ++part) {
    float since = kFarFrames, until = kFarFrames;
    for (int t = 0; t < count; ++t) {
      since = known[t][part] ? 0 : std::min(since + 1, kFarFrames);
      distances[t][part][0] = since;
    }
    for (int t = count - 1; t >= 0; --t) {
      until = known[t][part] ? 0 : std::min(until + 1, kFarFrames);
      distances[t][part][1] = until;
    }
  }
  return distances;
}

void fill_curves(const std::vector<KnownParts>& known, int first, int last, Motion& motion) {
  for (int part = 0; part < kPartCount; ++part) PartCurve(known, part, motion).fill(first, last);
}

}  // namespace understudy
