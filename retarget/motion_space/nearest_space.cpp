#include "retarget/motion_space/nearest_space.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kClipRate = 30;
constexpr float kOnFrame = 1e-3f;  // of a frame: so near to one is that one
constexpr int kBeside = 10;        // known frames that are looked at on each side of a gap

Joints seen_from(const Outlook& outlook, const Joints& joints) {
  return (joints.rowwise() - outlook.place.transpose()) * outlook.heading;
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
    const Window window{t - before, end + after - t + before, before, after, kClipRate / question.motion.fps};
    fill_window(question, window, motion);
    t = end;
  }
}

NearestSpace::Moment NearestSpace::moment(int first, float frames) {
  const float whole = std::floor(frames + kOnFrame);
  return {first + static_cast<int>(whole), frames - whole > kOnFrame ? frames - whole : 0};
}

Outlook NearestSpace::outlook_at(int clip, const Moment& at) const {
  const auto& views = views_[clip];
  Outlook here = views[at.frame].outlook;
  if (at.share == 0) return here;
  const Outlook& next = views[at.frame + 1].outlook;
  here.place += at.share * (next.place - here.place);
  here.heading += at.share * (next.heading - here.heading);
  const float length = here.heading.col(0).norm();  // both turn about y
  here.heading.col(0) /= length, here.heading.col(2) /= length;
  return here;
}

Joints NearestSpace::joints_at(int clip, const Moment& at) const {
  const auto& views = views_[clip];
  if (at.share == 0) return views[at.frame].joints;
  return (1 - at.share) * views[at.frame].joints + at.share * views[at.frame + 1].joints;
}

Pose NearestSpace::pose_at(int clip, const Moment& at) const {
  const auto& poses = clips_[clip].motion.poses;
  return at.share == 0 ? poses[at.frame] : between(poses[at.frame], poses[at.frame + 1], at.share);
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
  const auto frames = [&window](int t) { return window.step * static_cast<float>(t); };
  const int longest = static_cast<int>(std::ceil(frames(window.count - 1) - kOnFrame));
  ClipRun best;
  float least = std::numeric_limits<float>::infinity();
  for (const ClipRun& run : runs_)
    for (int first = run.first; first + longest < run.first + run.count; ++first) {
      const Outlook outlook = outlook_at(run.clip, moment(first, frames(window.outlook())));
      float sum = 0;
      for (size_t k = 0; k < known.size() && sum < least; ++k) {
        const Joints there = joints_at(run.clip, moment(first, frames(known[k].first)));
        sum += (seen_from(outlook, there) - known[k].second).squaredNorm();
      }
      if (sum < least) least = sum, best = {run.clip, first, longest + 1};
    }
  US_CHECK(best.count > 0, "no clip has ", longest + 1, " good frames in a row");
  return best;
}

void NearestSpace::fill_window(const KnownMotion& question, const Window& window, Motion& motion) const {
  const ClipRun found = nearest(question, window);
  const auto known = [&](int t) -> const Pose& { return question.motion.poses[window.first + t]; };
  const auto pose_of = [&](int t) {
    return pose_at(found.clip, moment(found.first, window.step * static_cast<float>(t)));
  };
  const Outlook there = Outlook::of(pose_of(window.outlook())), here = Outlook::of(known(window.outlook()));
  const auto like = [&](int t) { return here.placed(there.seen(pose_of(t))); };
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
