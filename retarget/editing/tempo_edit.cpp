#include "retarget/editing/tempo_edit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

constexpr std::array<int, 4> kEnds = {LeftWrist, RightWrist, LeftFoot, RightFoot};
constexpr float kSlowest = 0.5f;      // legs/s: a limb that moves slower rests
constexpr float kStrokeShare = 0.5f;  // of a movement's top speed
constexpr float kAround_s = 0.25f;    // of anticipation and recovery
constexpr float kEase_s = 0.1f;       // in which one phase's tempo becomes the next one's
constexpr uint32_t kSeed = 4;

/// Speed of the fastest of hands and feet beside the pelvis, legs/s.
float fastest_limb(const Joints& before, const Joints& now, float dt) {
  const float leg = std::max(leg_length(now), 1e-3f);
  float speed = 0;
  for (const int j : kEnds) {
    const Vec3 is = (now.row(j) - now.row(Pelvis)).transpose(),
               was = (before.row(j) - before.row(Pelvis)).transpose();
    if (dt > 0) speed = std::max(speed, (is - was).norm() / dt / leg);
  }
  return speed;
}

/// The same of each frame, a little smoothed.
std::vector<float> acting_speed(const std::vector<Joints>& joints, float fps) {
  std::vector<float> speed(joints.size(), 0);
  for (size_t t = 1; t < joints.size(); ++t) speed[t] = fastest_limb(joints[t - 1], joints[t], 1 / fps);
  if (speed.size() > 1) speed[0] = speed[1];
  return filtered(speed, half_gaussian(0.25f, fps));
}

struct Movement {
  int first = 0, last = 0;  // both inside
};

/// Of frames that are not at rest: one movement ends where the speed is below half of what is reached before
/// and after.
void add_movements(const std::vector<float>& speed, const Movement& run, std::vector<Movement>& found) {
  int first = run.first, lowest = run.first;
  float top = 0, low = 0;
  for (int t = run.first; t <= run.last; ++t) {
    if (low < kStrokeShare * top && low < kStrokeShare * speed[t]) {
      found.push_back({first, lowest});
      first = lowest + 1;
      top = 0;
    }
    if (speed[t] > top)
      top = low = speed[t];
    else if (speed[t] < low)
      low = speed[t], lowest = t;
  }
  found.push_back({first, run.last});
}

std::vector<Movement> movements(const std::vector<float>& speed) {
  std::vector<Movement> found;
  for (int t = 0; t < ssize(speed); ++t) {
    if (speed[t] < kSlowest) continue;
    Movement run{t, t};
    while (run.last + 1 < ssize(speed) && speed[run.last + 1] >= kSlowest) ++run.last;
    add_movements(speed, run, found);
    t = run.last;
  }
  return found;
}

float factor_of(const TempoEdit& edit, MovementPhase phase) {
  switch (phase) {
    case MovementPhase::Anticipation:
      return edit.anticipation;
    case MovementPhase::Stroke:
      return edit.stroke;
    case MovementPhase::Recovery:
      return edit.recovery;
    case MovementPhase::Rest:
      break;
  }
  return 1;
}

/// How long each frame lasts against the source's, marks apart.
std::vector<float> lengths_of(const TempoEdit& edit, const std::vector<Joints>& joints, float fps,
                              float base) {
  std::vector<float> lengths(joints.size(), base);
  if (edit.anticipation == 1 && edit.stroke == 1 && edit.recovery == 1 && edit.spread == 0) return lengths;
  const std::vector<MovementPhase> phases = movement_phases(joints, fps);
  for (size_t t = 0; t < lengths.size(); ++t) lengths[t] *= factor_of(edit, phases[t]);
  // The same movement twice is not as long twice; the draw is the same each time.
  std::mt19937 random(kSeed);
  std::normal_distribution<float> drawn(0, edit.spread);
  for (const Movement& one : movements(acting_speed(joints, fps))) {
    const float by =
        std::exp(edit.spread > 0 ? std::clamp(drawn(random), -2 * edit.spread, 2 * edit.spread) : 0.0f);
    for (int t = one.first; t <= one.last; ++t) lengths[t] *= by;
  }
  return filtered(lengths, half_gaussian(kEase_s / kSmoothestSeconds, fps));
}

/// Shifts what is between marks with them, evenly.
void shift(std::vector<TempoMark> marks, std::vector<double>& times) {
  const int last = static_cast<int>(times.size()) - 1;
  std::stable_sort(marks.begin(), marks.end(),
                   [](const auto& a, const auto& b) { return a.frame < b.frame; });
  const auto same_frame = [](const auto& a, const auto& b) { return a.frame == b.frame; };
  marks.erase(std::unique(marks.begin(), marks.end(), same_frame), marks.end());
  marks.erase(std::remove_if(marks.begin(), marks.end(), [&](const auto& mark) { return mark.frame > last; }),
              marks.end());
  if (marks.empty()) return;
  const std::vector<double> was = times;
  TempoMark from{0, 0};
  const auto between = [&](const TempoMark& to) {
    const double span = was[to.frame] - was[from.frame], wanted = span + to.later_s - from.later_s;
    constexpr double kMost = 20;  // times slower or faster than without marks
    US_CHECK(to.frame == from.frame || (wanted * kMost >= span && wanted <= kMost * span),
             "the tempo of frames ", from.frame, " to ", to.frame, " would stop time or turn it back");
    for (int t = from.frame + 1; t <= to.frame; ++t)
      times[t] = was[from.frame] + from.later_s + (was[t] - was[from.frame]) / span * wanted;
    from = to;
  };
  if (marks.front().frame == 0) marks.front().later_s = 0;  // a take begins at 0
  for (const TempoMark& mark : marks) between(mark);
  for (int t = from.frame + 1; t <= last; ++t) times[t] = was[t] + from.later_s;
}

}  // namespace

float body_tempo(float leg_target_m, float leg_source_m) {
  return std::sqrt(std::max(leg_target_m, 1e-4f) / std::max(leg_source_m, 1e-4f));
}

std::vector<MovementPhase> movement_phases(const std::vector<Joints>& joints, float fps) {
  const std::vector<float> speed = acting_speed(joints, fps);
  std::vector<MovementPhase> phases(joints.size(), MovementPhase::Rest);
  const int around = std::max(1, static_cast<int>(std::lround(kAround_s * fps))),
            count = static_cast<int>(speed.size());
  int free = 0;  // first frame that no movement has yet
  for (const Movement& one : movements(speed)) {
    const float top = *std::max_element(speed.begin() + one.first, speed.begin() + one.last + 1);
    const float fast = std::max(kSlowest, kStrokeShare * top);
    int first = one.first, last = one.last;
    while (first < last && speed[first] < fast) ++first;
    while (last > first && speed[last] < fast) --last;
    for (int t = std::max(free, first - around); t < first; ++t) phases[t] = MovementPhase::Anticipation;
    for (int t = first; t <= last; ++t) phases[t] = MovementPhase::Stroke;
    free = std::min(count, std::max(one.last + 1, last + 1 + around));
    for (int t = last + 1; t < free; ++t) phases[t] = MovementPhase::Recovery;
  }
  return phases;
}

std::vector<double> tempo_times(const TempoEdit& edit, const std::vector<Joints>& joints, float fps,
                                float leg_ratio) {
  US_CHECK(fps > 0 && std::isfinite(fps), "a motion cannot have ", fps, " frames a second");
  const float base = edit.by == TempoBy::Body ? body_tempo(leg_ratio, 1) : edit.length;
  US_CHECK(std::isfinite(base) && base > 0, "a take cannot last ", base, " times as long");
  const std::vector<float> lengths = lengths_of(edit, joints, fps, base);
  std::vector<double> times(joints.size(), 0);
  for (size_t t = 1; t < times.size(); ++t)
    times[t] =
        times[t - 1] + 0.5 * static_cast<double>(lengths[t - 1] + lengths[t]) / static_cast<double>(fps);
  shift(edit.marks, times);
  return times;
}

std::vector<MomentBetween> moments_of(const std::vector<int>& kept, const std::vector<double>& times,
                                      float fps) {
  std::vector<MomentBetween> moments;
  if (times.empty() || kept.size() < 2) {
    for (const int frame : kept) moments.push_back({frame, frame, 0});
    return moments;
  }
  std::vector<double> at(kept.size(), 0);  // of the kept frames; what is left out takes no time
  for (size_t i = 1; i < kept.size(); ++i) at[i] = at[i - 1] + times[kept[i - 1] + 1] - times[kept[i - 1]];
  const double step = 1 / static_cast<double>(fps);
  const auto count = static_cast<int64_t>(std::ceil(at.back() / step - 1e-6)) + 1;
  size_t i = 0;
  for (int64_t k = 0; k < count; ++k) {
    const double now = std::min(static_cast<double>(k) * step, at.back());
    while (i + 2 < kept.size() && at[i + 1] <= now) ++i;
    moments.push_back({kept[i], kept[i + 1], static_cast<float>((now - at[i]) / (at[i + 1] - at[i]))});
  }
  return moments;
}

Pose pose_between(const Pose& before, const Pose& after, float share) {
  if (share <= 0) return before;
  if (share >= 1) return after;
  Pose pose;
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] = Eigen::Quaternionf(before.local[j])
                        .slerp(share, Eigen::Quaternionf(after.local[j]))
                        .toRotationMatrix();
  pose.root = (1 - share) * before.root + share * after.root;
  return pose;
}

float LiveTempo::push(const Joints& joints, float dt, float length) {
  const double at = kept_.empty() ? 0 : kept_.back().at + static_cast<double>(dt);
  kept_.push_back({at, !kept_.empty() && fastest_limb(last_, joints, dt) >= kSlowest});
  last_ = joints;
  if (kept_.size() == 1) return behind_;
  // What is shown next decides how fast time goes on.
  const double now = at - static_cast<double>(dt + behind_);
  const auto next = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& one) { return one.at > now; });
  const float rate = next != kept_.end() && next->fast ? 1 / length : length;
  behind_ = std::clamp(behind_ + dt * (1 - rate), 0.0f, delay_);
  while (kept_.size() > 2 && kept_[1].at <= at - static_cast<double>(behind_)) kept_.pop_front();
  return behind_;
}

}  // namespace understudy
