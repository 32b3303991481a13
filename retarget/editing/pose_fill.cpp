#include "retarget/editing/pose_fill.hpp"

#include <algorithm>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/skeleton/limb_ik.hpp"
#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {
namespace {

constexpr float kSamePlace_m = 0.05f;  // that the ankle of a standing foot moves at most, leg 0.8 m

void hold_foot(int side, int before, int after, const Joints& rest, Motion& motion) {
  const int ankle = Leg::of(side).ankle;
  const auto ankle_at = [&](int t) -> Vec3 {
    return forward_kinematics(rest, motion.poses[t]).joints.row(ankle).transpose();
  };
  const Vec3 from = ankle_at(before), to = ankle_at(after);
  if ((to - from).norm() > kSamePlace_m * leg_length(rest) / 0.8f) return;
  for (int t = before + 1; t < after; ++t) {
    const float share = static_cast<float>(t - before) / static_cast<float>(after - before);
    place_ankle(rest, side, from + share * (to - from), motion.poses[t]);
    motion.standing[t][side] = true;
  }
}

}  // namespace

void fill_frames(const FillEdit& fill, const Joints& rest, Motion& motion) {
  const int count = ssize(motion.poses), before = fill.first - 1, after = fill.last + 1;
  US_CHECK(fill.first >= 0 && fill.first <= fill.last && fill.last < count, "frames ", fill.first, " to ",
           fill.last, " cannot be filled: the motion has frames 0 to ", count - 1);
  US_CHECK(before >= 0 || after < count, "all frames are to be filled: none is left that is known");
  if (!motion.standing.empty())
    for (int t = fill.first; t <= fill.last; ++t) motion.standing[t] = {};
  std::vector<KnownParts> known(motion.poses.size(), all_parts(true));
  std::fill(known.begin() + fill.first, known.begin() + after, all_parts(false));
  fill_curves(known, fill.first, fill.last, motion);
  if (motion.standing.empty() || before < 0 || after >= count) return;
  for (int side = 0; side < 2; ++side)
    if (motion.standing[before][side] && motion.standing[after][side])
      hold_foot(side, before, after, rest, motion);
}

}  // namespace understudy
