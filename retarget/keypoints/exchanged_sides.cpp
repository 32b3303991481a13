#include "retarget/keypoints/exchanged_sides.hpp"

#include <utility>

namespace understudy {
namespace {

constexpr float kLongestExchange = 1;  // seconds
constexpr float kMuchNearer = 0.5f;    // the other way's distance against this one's
// How much nearer on average, in the person's size: above the jitter of arms and legs, and of a head.
constexpr std::array<float, ExchangedSides::kGroups> kLeastGain = {0.03f, 0.03f, 0.012f};

struct WayCosts {
  float straight = 0, exchanged = 0;
  int points = 0;
};

/// Mean distances to what is expected, as the file has the sides and the other way round.
WayCosts way_costs(const FlatPose& seen, const FlatPose& expected, int group) {
  WayCosts costs;
  for (int p = 0; p < kBodyPoints; ++p) {
    const int other = kBodyMirror[p];
    if (!ExchangedSides::is_in_group(p, group) || !seen.has(p) || !expected.has(p) || !expected.has(other))
      continue;
    costs.straight += (seen.at(p) - expected.at(p)).norm();
    costs.exchanged += (seen.at(p) - expected.at(other)).norm();
    ++costs.points;
  }
  if (costs.points > 0) {
    costs.straight /= static_cast<float>(costs.points);
    costs.exchanged /= static_cast<float>(costs.points);
  }
  return costs;
}

}  // namespace

bool ExchangedSides::is_in_group(int point, int group) {
  using namespace body25;
  if (kBodyMirror[static_cast<size_t>(point)] == point) return false;
  const bool is_arm = point <= LeftWrist, is_head = point >= RightEye && point <= LeftEar;
  return group == (is_arm ? 0 : is_head ? 2 : 1);
}

ExchangedSides::Mended ExchangedSides::mend(const FlatPose& seen, const FlatPose& expected, float size,
                                            float dt) {
  Mended out;
  out.pose = seen;
  for (int group = 0; group < kGroups; ++group) {
    const auto g = static_cast<size_t>(group);
    const WayCosts costs = way_costs(seen, expected, group);
    const float gain = kLeastGain[g] * size;
    if (costs.points < 2) continue;
    if (costs.exchanged < kMuchNearer * costs.straight && costs.straight - costs.exchanged > gain)
      exchanged_[g] = true;
    else if (costs.straight < kMuchNearer * costs.exchanged && costs.exchanged - costs.straight > gain)
      exchanged_[g] = false;
    for_s_[g] = exchanged_[g] ? for_s_[g] + dt : 0;
    if (!exchanged_[g]) continue;
    if (for_s_[g] > kLongestExchange) {
      exchanged_[g] = false;
      for_s_[g] = 0;
      out.believed[g] = true;
      continue;
    }
    out.any = true;
    for (int p = 0; p < kBodyPoints; ++p)
      if (is_in_group(p, group)) out.pose.body.row(p) = seen.body.row(kBodyMirror[static_cast<size_t>(p)]);
    if (group == 0) std::swap(out.pose.left_hand, out.pose.right_hand);
  }
  return out;
}

}  // namespace understudy
