#include "retarget/editing/pose_fill.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/skeleton/curve_doubt.hpp"
#include "retarget/skeleton/foot_hold.hpp"

namespace understudy {
namespace {

constexpr float kSamePlace_m = 0.05f;  // that the ball of a standing foot moves at most, leg 0.8 m
constexpr float kAtOnce_s = 1;         // of a prediction: farther on the motion space knows little

/// A foot that stands before and after, at one place, stands meanwhile.
void hold_feet(const FillEdit& fill, const Joints& rest, Motion& motion) {
  const int before = fill.first - 1, after = fill.last + 1;
  if (motion.standing.empty() || before < 0 || after >= ssize(motion.poses)) return;
  const Joints from = forward_kinematics(rest, motion.poses[before]).joints,
               to = forward_kinematics(rest, motion.poses[after]).joints;
  for (int side = 0; side < 2; ++side) {
    const float apart = (to.row(LeftFoot + side) - from.row(LeftFoot + side)).norm();
    if (!motion.standing[before][side] || !motion.standing[after][side]) continue;
    if (apart > kSamePlace_m * leg_length(rest) / 0.8f) continue;
    for (int t = fill.first; t <= fill.last; ++t) motion.standing[t][side] = true;
  }
  hold_standing(rest, fill.first, fill.last, motion);
}

Motion curve_through(const KnownMotion& question, const std::vector<FillEdit>& fills) {
  Motion motion = question.motion;
  fill_curves(question.known, 0, ssize(motion.poses) - 1, motion);
  motion.doubt_m = curve_doubt(question.known, question.motion, question.rest);
  const std::vector<float>& before = question.motion.doubt_m;  // of frames that came as made ones
  for (size_t t = 0; t < before.size(); ++t)
    if (question.known[t] == all_parts(true)) motion.doubt_m[t] = before[t];
  for (const FillEdit& fill : fills) hold_feet(fill, question.rest, motion);
  return motion;
}

/// The learned answer, as far as it is wanted, in place of the curve.
void put_learned(const FillEdit& fill, const Completion& made, Motion& motion) {
  for (int t = fill.first; t <= fill.last; ++t) {
    motion.poses[t] = between(motion.poses[t], made.motion.poses[t], fill.learned);
    motion.doubt_m[t] += fill.learned * (made.doubt_m[t] - motion.doubt_m[t]);
    if (!motion.standing.empty() && fill.learned >= 0.5f) motion.standing[t] = made.motion.standing[t];
  }
}

}  // namespace

bool need_space(const std::vector<FillEdit>& fills) {
  return std::any_of(fills.begin(), fills.end(), [](const FillEdit& fill) { return fill.learned > 0; });
}

std::string guess_of(const FillEdit& fill, int frames, double fps) {
  constexpr double kFar_s = 3;  // about as long as what the motion space looks over
  const std::string which = "frames " + std::to_string(fill.first) + " to " + std::to_string(fill.last);
  const double seconds = (fill.last - fill.first + 1) / fps;
  if (fill.first <= 0) return which + " are a guess: nothing before them is known";
  if (fill.last >= frames - 1) return which + " are a guess: nothing after them is known";
  if (seconds <= kFar_s) return "";
  return which + printed(" are %.1f seconds: what happens in the middle of them is a guess", seconds);
}

void fill_frames(const std::vector<FillEdit>& fills, const Joints& rest, MotionSpace* space, Motion& motion) {
  if (fills.empty()) return;
  const int count = ssize(motion.poses);
  KnownMotion question{motion, std::vector<KnownParts>(motion.poses.size(), all_parts(true)), rest};
  for (const FillEdit& fill : fills) {
    US_CHECK(fill.first >= 0 && fill.first <= fill.last && fill.last < count, "frames ", fill.first, " to ",
             fill.last, " cannot be filled: the motion has frames 0 to ", count - 1);
    for (int t = fill.first; t <= fill.last; ++t) {
      question.known[t] = all_parts(false);
      if (!motion.standing.empty()) question.motion.standing[t] = {};
    }
  }
  US_CHECK(std::any_of(question.known.begin(), question.known.end(),
                       [](const KnownParts& parts) { return parts == all_parts(true); }),
           "all frames are to be filled: none is left that is known");
  motion = curve_through(question, fills);
  if (space == nullptr || !need_space(fills)) return;
  for (question.variation = 0; question.variation < kMostVariations; ++question.variation) {
    const auto wants = [&question](const FillEdit& fill) {
      return fill.learned > 0 && fill.variation == question.variation;
    };
    if (std::none_of(fills.begin(), fills.end(), wants)) continue;
    const Completion made = space->complete(question);
    for (const FillEdit& fill : fills)
      if (wants(fill)) put_learned(fill, made, motion);
  }
}

int frames_added(const GoOnEdit& edit, double fps) {
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(edit.seconds) * fps)));
}

void go_on(const GoOnEdit& edit, const Joints& rest, MotionSpace* space, Motion& motion) {
  US_CHECK(!motion.poses.empty(), "a motion without frames cannot go on");
  const size_t wanted = motion.poses.size() + static_cast<size_t>(frames_added(edit, motion.fps));
  const auto at_once = static_cast<size_t>(frames_added({kAtOnce_s}, motion.fps));
  float doubt = 0;  // at the end of what was made before
  while (motion.poses.size() < wanted) {
    const size_t first = motion.poses.size(), count = std::min(wanted, first + at_once);
    std::vector<float> told = std::move(motion.doubt_m);
    told.resize(first);
    motion.poses.resize(count, Pose(motion.poses.back()));
    if (!motion.flags.empty()) motion.flags.resize(count);
    if (!motion.standing.empty()) motion.standing.resize(count);
    const FillEdit added{static_cast<int>(first), static_cast<int>(count) - 1, edit.learned, edit.variation};
    fill_frames({added}, rest, space, motion);
    std::copy(told.begin(), told.end(), motion.doubt_m.begin());
    for (size_t t = first; t < count; ++t) motion.doubt_m[t] += doubt;
    doubt = motion.doubt_m.back();
  }
}

}  // namespace understudy
