#include "retarget/motion_space/nearest_space.hpp"

#include <algorithm>
#include <climits>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kBeside = 10;  // known frames that are looked at on each side of a gap

Joints seen_from(const Outlook& outlook, const Joints& joints) {
  return (joints.rowwise() - outlook.place.transpose()) * outlook.heading;
}

Pose back_from(const Outlook& outlook, Pose pose) {
  pose.root = outlook.place + outlook.heading * pose.root;
  pose.local[Pelvis] = outlook.heading * pose.local[Pelvis];
  return pose;
}

bool is_whole(const KnownMotion& question, int t) {
  return t >= 0 && t < ssize(question.known) && question.known[t] == all_parts(true);
}

/// What brings pose `from` to pose `to`: rotations in the parents' frames, and a way.
Pose residual(const Pose& from, const Pose& to) {
  Pose off;
  for (int j = 0; j < kJointCount; ++j) off.local[j] = to.local[j] * from.local[j].transpose();
  off.root = to.root - from.root;
  return off;
}

void bend(const Pose& off_before, const Pose& off_after, float share, Pose& pose) {
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3& a = off_before.local[j];
    const Vec3 turn = rotation_to_axis_angle(a.transpose() * off_after.local[j]);
    pose.local[j] = a * rotation_from_axis_angle(share * turn) * pose.local[j];
  }
  pose.root += off_before.root + share * (off_after.root - off_before.root);
}

}  // namespace

NearestSpace::NearestSpace(std::vector<Clip> clips)
    : PlainSpace({0.66f, 1.06f, 0.77f}), clips_(std::move(clips)) {
  US_CHECK(!clips_.empty(), "the nearest motion is looked for among no clips");
  const size_t count = clips_.size();
  for (size_t c = 0; c < count; ++c) {
    Clip other = clips_[c];
    for (Pose& pose : other.motion.poses) pose = mirrored(pose);
    clips_.push_back(std::move(other));
  }
  runs_ = good_runs(clips_, 1, INT_MAX);
}

void NearestSpace::set_rest(const Joints& rest) {
  if (!views_.empty() && rest == rest_) return;
  rest_ = rest;
  views_.clear();
  for (const Clip& clip : clips_) {
    auto& views = views_.emplace_back();
    for (const Pose& pose : clip.motion.poses)
      views.push_back({forward_kinematics(rest, pose).joints, Outlook::of(pose)});
  }
}

void NearestSpace::fill(const KnownMotion& question, Motion& motion) {
  const int count = static_cast<int>(ssize(question.known));
  bool any = false;
  for (int t = 0; t < count; ++t) any |= is_whole(question, t);
  if (!any) return fill_curves(question.known, 0, count - 1, motion);
  set_rest(question.rest);
  for (int t = 0; t < count; ++t) {
    if (is_whole(question, t)) continue;
    int before = 0, after = 0, end = t;
    while (end < count && !is_whole(question, end)) ++end;
    while (before < kBeside && is_whole(question, t - before - 1)) ++before;
    while (after < kBeside && is_whole(question, end + after)) ++after;
    fill_window(question, {t - before, end + after - t + before, before, after}, motion);
    t = end;
  }
}

ClipRun NearestSpace::nearest(const KnownMotion& question, const Window& window) const {
  const Outlook from = Outlook::of(question.motion.poses[window.first + window.outlook()]);
  std::vector<std::pair<int, Joints>> known;  // those at the gap first: they tell most
  for (int i = 0; i < kBeside; ++i)
    for (const int t : {window.count - window.after + i, window.before - 1 - i})
      if (i < (t < window.before ? window.before : window.after))
        known.emplace_back(
            t, seen_from(from,
                         forward_kinematics(question.rest, question.motion.poses[window.first + t]).joints));
  ClipRun best;
  float least = std::numeric_limits<float>::infinity();
  for (const ClipRun& run : runs_)
    for (int first = run.first; first + window.count <= run.first + run.count; ++first) {
      const auto& views = views_[run.clip];
      const Outlook& outlook = views[first + window.outlook()].outlook;
      float sum = 0;
      for (size_t k = 0; k < known.size() && sum < least; ++k)
        sum += (seen_from(outlook, views[first + known[k].first].joints) - known[k].second).squaredNorm();
      if (sum < least) least = sum, best = {run.clip, first, window.count};
    }
  US_CHECK(best.count > 0, "no clip has ", window.count, " good frames in a row");
  return best;
}

void NearestSpace::fill_window(const KnownMotion& question, const Window& window, Motion& motion) const {
  const ClipRun found = nearest(question, window);
  const auto known = [&](int t) -> const Pose& { return question.motion.poses[window.first + t]; };
  const auto& poses = clips_[found.clip].motion.poses;
  const Outlook there = Outlook::of(poses[found.first + window.outlook()]),
                here = Outlook::of(known(window.outlook()));
  const auto like = [&](int t) { return back_from(here, there.seen(poses[found.first + t])); };
  const int before = window.before - 1, after = window.count - window.after;
  const int one_end = window.before > 0 ? before : after;  // that there is
  const int from = window.before > 0 ? before : one_end, to = window.after > 0 ? after : one_end;
  const Pose off_from = residual(like(from), known(from)), off_to = residual(like(to), known(to));
  for (int t = before + 1; t < after; ++t) {
    Pose& pose = motion.poses[window.first + t];
    pose = like(t);
    bend(off_from, off_to, static_cast<float>(t - before) / static_cast<float>(after - before), pose);
  }
}

}  // namespace understudy
