#include "retarget/motion_space/steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/motion_window.hpp"

namespace understudy {
namespace {

constexpr float kShortest = 0.3f, kLongest = 3;  // seconds
constexpr float kLeastSwing = 0.5f;              // radians, of left less right hip flexion
// Radians a frame. Permissive, as the paper's: sidesteps, runs and dances come along.
constexpr float kMostDistance = 0.7f;

struct FrameRange {
  int first = 0, last = 0;  // both inside
};

using Hips = std::array<Mat3, 2>;

std::vector<Hips> hips_of(const Motion& motion, int first, int last) {
  std::vector<Hips> hips;
  for (int t = first; t <= last; ++t)
    hips.push_back({motion.poses[t].local[LeftHip], motion.poses[t].local[RightHip]});
  return hips;
}

/// How far the thigh is before the pelvis' own down, radians.
float flexion(const Mat3& hip) {
  const Vec3 thigh = -hip.col(1);
  return std::atan2(thigh.z(), -thigh.y());
}

/// Of each frame the left hip's flexion less the right's: above 0 while the left thigh is in front.
std::vector<float> left_before_right(const Motion& motion) {
  std::vector<float> swing;
  for (const Pose& pose : motion.poses)
    swing.push_back(flexion(pose.local[LeftHip]) - flexion(pose.local[RightHip]));
  return swing;
}

/// Frames of a range at which `side` (1 left, -1 right) comes to the front.
std::vector<int> strides(const std::vector<float>& swing, float side, const FrameRange& range) {
  std::vector<int> frames;
  for (int t = range.first + 1; t <= range.last; ++t)
    if (side * swing[t - 1] < 0 && side * swing[t] >= 0) frames.push_back(t);
  return frames;
}

/// Dynamic time warping: the mean angle between both hips' rotations along the cheapest way to walk both
/// sequences from their beginnings to their ends, radians a pair of frames.
float warped_distance(const std::vector<Hips>& a, const std::vector<Hips>& b) {
  struct Way {
    float sum = std::numeric_limits<float>::infinity();
    int pairs = 0;
  };
  std::vector<Way> before(b.size()), now(b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = 0; j < b.size(); ++j) {
      Way best = before[j];
      if (j > 0)
        for (const Way& way : {before[j - 1], now[j - 1]})
          if (way.sum < best.sum) best = way;
      if (i == 0 && j == 0) best = {0, 0};
      const float apart = geodesic_angle(a[i][0], b[j][0]) + geodesic_angle(a[i][1], b[j][1]);
      now[j] = {best.sum + 0.5f * apart, best.pairs + 1};
    }
    std::swap(before, now);
    std::fill(now.begin(), now.end(), Way());
  }
  return before.back().sum / static_cast<float>(before.back().pairs);
}

/// One cycle of the built-in walk from a stride of that side.
std::vector<Hips> reference_cycle(bool left_first) {
  Motion walk = builtin_motion("walk", builtin_joints());
  if (!left_first)  // in a mirror, so that neither side is favoured
    for (Pose& pose : walk.poses) pose = mirrored(pose);
  const auto frames = strides(left_before_right(walk), left_first ? 1.0f : -1.0f,
                              {0, static_cast<int>(ssize(walk.poses)) - 1});
  US_CHECK(frames.size() > 2, "the built-in walk has no cycle");
  return hips_of(walk, frames[1], frames[2]);
}

struct Reference {
  std::vector<Hips> left_first, right_first;
};

const Reference& reference() {
  static const Reference cycles{reference_cycle(true), reference_cycle(false)};
  return cycles;
}

/// The steps among frames first .. last, none of which has a flag. swing: see left_before_right.
void add_steps(const Motion& motion, const std::vector<float>& swing, const FrameRange& run,
               std::vector<Step>& steps) {
  for (const bool left_first : {true, false}) {
    const auto frames = strides(swing, left_first ? 1.0f : -1.0f, run);
    for (size_t i = 0; i + 1 < frames.size(); ++i) {
      Step step{frames[i], frames[i + 1], left_first, 0};
      const float seconds = static_cast<float>(step.last - step.first) / motion.fps;
      const auto [least, most] =
          std::minmax_element(swing.begin() + step.first, swing.begin() + step.last + 1);
      if (seconds < kShortest || seconds > kLongest || *most - *least < kLeastSwing) continue;
      step.distance = warped_distance(hips_of(motion, step.first, step.last),
                                      left_first ? reference().left_first : reference().right_first);
      if (step.distance <= kMostDistance) steps.push_back(step);
    }
  }
}

}  // namespace

std::vector<Step> find_steps(const Motion& motion) {
  const int count = static_cast<int>(ssize(motion.poses));
  US_CHECK(motion.flags.empty() || ssize(motion.flags) == count, "a motion of ", count, " frames has ",
           motion.flags.size(), " flags");
  const auto good = [&](int t) { return motion.flags.empty() || motion.flags[t] == 0; };
  const auto swing = left_before_right(motion);
  std::vector<Step> steps;
  for (int first = 0, end = 0; first < count; first = end) {
    while (end < count && good(end) == good(first)) ++end;
    if (good(first)) add_steps(motion, swing, {first, end - 1}, steps);
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.first < b.first; });
  return steps;
}

TimedPoses movement_of(const Motion& motion, int first, int last) {
  US_CHECK(first >= 0 && first <= last && last < ssize(motion.poses), "a motion of ", motion.poses.size(),
           " frames has no frames ", first, " to ", last);
  Outlook outlook = Outlook::of(motion.poses[first]);
  outlook.place.y() = 0;
  TimedPoses movement;
  for (int t = first; t <= last; ++t) {
    movement.poses.push_back(outlook.seen(motion.poses[t]));
    movement.seconds.push_back(static_cast<float>(t - first) / motion.fps);
  }
  return movement;
}

}  // namespace understudy
