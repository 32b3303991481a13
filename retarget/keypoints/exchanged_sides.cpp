#include "retarget/keypoints/exchanged_sides.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understudy {
namespace {

constexpr float kLongestExchange = 1, kShortestExchange = 0.1f;  // seconds until the file is believed
constexpr float kMuchNearer = 0.5f;  // the other way's distance against this one's
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

/// Two points that lie side by side, and how far apart at least, in the person's size, to tell an order.
struct SidePair {
  int right, left;
  float least;
};
constexpr SidePair kShoulders = {body25::RightShoulder, body25::LeftShoulder, 0.05f},
                   kHipSides = {body25::RightHip, body25::LeftHip, 0.03f},
                   kEyes = {body25::RightEye, body25::LeftEye, 0.025f},
                   kEars = {body25::RightEar, body25::LeftEar, 0.04f};

/// -1: the right one is on the picture's left; 1: on its right; 0: nobody can tell.
int order_of(const FlatPose& pose, const SidePair& pair, float size) {
  if (!pose.has(pair.right) || !pose.has(pair.left)) return 0;
  const float apart = pose.at(pair.right).x() - pose.at(pair.left).x();
  return std::abs(apart) < pair.least * size ? 0 : apart < 0 ? -1 : 1;
}

int head_order(const FlatPose& pose, float size) {
  const int ears = order_of(pose, kEars, size);
  return ears != 0 ? ears : order_of(pose, kEyes, size);
}

void put_back(int group, ExchangedSides::Mended& mended) {
  const BodyPoints seen = mended.pose.body;
  for (int p = 0; p < kBodyPoints; ++p)
    if (ExchangedSides::is_in_group(p, group))
      mended.pose.body.row(p) = seen.row(kBodyMirror[static_cast<size_t>(p)]);
  if (group == 0) std::swap(mended.pose.left_hand, mended.pose.right_hand);
  mended.any = true;
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
    if (!exchanged_[g]) {
      for_s_[g] = 0;
      before_s_[g] = std::min(before_s_[g] + dt, kLongestExchange);
      continue;
    }
    for_s_[g] += dt;
    if (for_s_[g] > std::max(before_s_[g], kShortestExchange)) {
      exchanged_[g] = false;
      for_s_[g] = before_s_[g] = 0;
      out.believed[g] = true;
      continue;
    }
    put_back(group, out);
  }
  return out;
}

ExchangedSides::Mended ExchangedSides::mend_first(const FlatPose& seen, float size) const {
  Mended out;
  out.pose = seen;
  const std::array<int, kGroups> order = {order_of(seen, kShoulders, size), order_of(seen, kHipSides, size),
                                          head_order(seen, size)};
  for (int group = 0; group < kGroups; ++group) {
    const int here = order[static_cast<size_t>(group)],
              one = order[static_cast<size_t>((group + 1) % kGroups)],
              other = order[static_cast<size_t>((group + 2) % kGroups)];
    if (here != 0 && one == -here && other == -here) put_back(group, out);
  }
  return out;
}

}  // namespace understudy
