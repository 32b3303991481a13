#include "retarget/motion_space/motion_window.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {

Outlook Outlook::of(const Pose& pose) {
  return {pose.root, rotation_about_y(heading_of(pose.local[Pelvis]))};
}

Pose Outlook::seen(Pose pose) const {
  pose.root = heading.transpose() * (pose.root - place);
  pose.local[Pelvis] = heading.transpose() * pose.local[Pelvis];
  return pose;
}

std::vector<Pose> Outlook::seen(std::vector<Pose> poses) const {
  for (Pose& pose : poses) pose = seen(pose);
  return poses;
}

Pose Outlook::placed(Pose pose) const {
  pose.root = place + heading * pose.root;
  pose.local[Pelvis] = heading * pose.local[Pelvis];
  return pose;
}

std::vector<KnownParts> known_of(const MotionWindow& window) {
  std::vector<KnownParts> known(window.distance.size());
  for (size_t i = 0; i < known.size(); ++i)
    for (size_t part = 0; part < kPartCount; ++part) known[i][part] = window.distance[i][part][0] == 0;
  return known;
}

namespace {

// Known samples on each side of gaps; on the one side where there is no other; from how many on gaps are
// apart. On dev few are best between, and all that there are where a motion goes on.
constexpr int kContext = 4, kOneSided = 24, kApart = 12;

/// Frames first .. last that are not wholly known.
struct Gap {
  int first = 0, last = 0;
};

std::vector<Gap> gaps_in(const std::vector<KnownParts>& known) {
  std::vector<Gap> gaps;
  for (int t = 0; t < ssize(known); ++t) {
    if (known[t] == all_parts(true)) continue;
    if (gaps.empty() || gaps.back().last + 1 < t) gaps.push_back({t, t});
    gaps.back().last = t;
  }
  return gaps;
}

/// Of a moment between two frames, in samples.
KnownDistance distance_at(const KnownDistance& before, const KnownDistance& after, float share, float step) {
  KnownDistance at = before;
  for (size_t part = 0; part < kPartCount; ++part) {
    const bool known = before[part][0] == 0 && (share == 0 || after[part][0] == 0);
    if (known) {
      at[part] = {0, 0};
      continue;
    }
    const float until = share == 0 ? before[part][1] : after[part][1] + 1 - share;
    at[part] = {std::min((before[part][0] + share) / step, kFarFrames), std::min(until / step, kFarFrames)};
    if (before[part][0] == kFarFrames) at[part][0] = kFarFrames;
    if (until >= kFarFrames) at[part][1] = kFarFrames;
  }
  return at;
}

/// The samples of one window over gaps that lie near each other.
class WindowMaker {
 public:
  WindowMaker(const std::vector<KnownParts>& known, const Motion& curve, const Joints& rest)
      : curve_(curve), rest_(rest), distances_(known_distances(known)) {}

  bool fits(const Gap& gap) const { return ends(gap, gap).samples <= kLongestWindow; }
  /// Gaps with so few known frames between that one is to know of the other.
  bool belong_together(const std::vector<Gap>& gaps, const Gap& next) const {
    return static_cast<float>(next.first - gaps.back().last) <= kApart * step() &&
           ends(gaps.front(), next).samples <= kLongestWindow;
  }

  MotionWindow window(const std::vector<Gap>& gaps) const {
    MotionWindow window;
    window.rest = rest_;
    window.step = step();
    const Ends at = ends(gaps.front(), gaps.back());
    window.first = at.first;
    for (const Gap& gap : gaps)
      for (int t = gap.first; t <= gap.last; ++t) window.gap_frames.push_back(t);
    for (int i = 0; i < at.samples; ++i) add_sample(at.first + static_cast<float>(i) * step(), window);
    window.outlook = Outlook::of(window.curve[static_cast<size_t>(outlook_frame(known_of(window)))]);
    window.curve = window.outlook.seen(std::move(window.curve));
    return window;
  }

 private:
  struct Ends {
    float first = 0;
    int samples = 0;
  };

  float step() const { return curve_.fps / kWindowRate; }
  float last_frame() const { return static_cast<float>(curve_.poses.size() - 1); }

  /// A sample is at the last known frame before the gaps, or at their first.
  Ends ends(const Gap& first, const Gap& last) const {
    const bool before = first.first > 0, after = last.last < last_frame();
    const float from = static_cast<float>(before ? first.first - 1 : first.first);
    const float to = std::min(static_cast<float>(last.last + 1), last_frame());
    const float room_before = std::floor(from / step()), room_after = (last_frame() - to) / step();
    const auto context = static_cast<float>(before && after ? kContext : kOneSided);
    Ends ends;
    ends.first = from - std::min(room_before, context - 1) * step();
    ends.samples =
        1 + static_cast<int>((to + std::min(room_after, context - 1) * step() - ends.first) / step() + 1e-3f);
    return ends;
  }

  void add_sample(float frame, MotionWindow& window) const {
    const int last = ssize(curve_.poses) - 1;
    const int before = std::clamp(static_cast<int>(frame + 1e-3f), 0, last),
              after = std::min(before + 1, last);
    float share = std::clamp(frame - static_cast<float>(before), 0.0f, 1.0f);
    if (share < 1e-3f || after == before) share = 0;
    window.curve.push_back(between(curve_.poses[before], curve_.poses[after], share));
    window.distance.push_back(distance_at(distances_[before], distances_[after], share, step()));
  }

  const Motion& curve_;
  const Joints& rest_;
  std::vector<KnownDistance> distances_;
};

}  // namespace

std::vector<MotionWindow> windows_of(const std::vector<KnownParts>& known, const Motion& curve,
                                     const Joints& rest) {
  const WindowMaker maker(known, curve, rest);
  std::vector<MotionWindow> windows;
  std::vector<Gap> together;
  const auto close = [&] {
    if (!together.empty()) windows.push_back(maker.window(together));
    together.clear();
  };
  for (const Gap& gap : gaps_in(known)) {
    if (!together.empty() && !maker.belong_together(together, gap)) close();
    if (maker.fits(gap)) together.push_back(gap);
  }
  close();
  return windows;
}

MotionWindow mirrored(const MotionWindow& window) {
  MotionWindow mirror = window;
  for (int j = 0; j < kJointCount; ++j) mirror.rest.row(j) = window.rest.row(kMirror[j]);
  mirror.rest.col(0) *= -1;
  for (Pose& pose : mirror.curve) pose = mirrored(pose);
  for (size_t i = 0; i < window.distance.size(); ++i)
    for (int j = 0; j < kJointCount; ++j) mirror.distance[i][j] = window.distance[i][kMirror[j]];
  return mirror;
}

int outlook_frame(const std::vector<KnownParts>& known) {
  int last = -1;
  for (int t = 0; t < ssize(known); ++t) {
    const bool whole = known[t] == all_parts(true);
    if (!whole && last >= 0) return last;
    if (whole) last = t;
  }
  return std::max(0, last);
}

}  // namespace understudy
