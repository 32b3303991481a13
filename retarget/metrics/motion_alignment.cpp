#include "retarget/metrics/motion_alignment.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr double kAlignedRate = 15;

std::vector<const Rotations*> thinned(const std::vector<Rotations>& all, double fps) {
  std::vector<const Rotations*> some;
  const double step = std::max(1.0, fps / kAlignedRate);
  for (double at = 0; at < static_cast<double>(all.size()); at += step)
    some.push_back(&all[static_cast<size_t>(at)]);
  return some;
}

/// Radians, the mean over joints.
float apart(const Rotations& a, const Rotations& b) {
  float sum = 0;
  for (int j = 1; j < kJointCount; ++j) {
    const float trace = a[j].cwiseProduct(b[j]).sum();
    sum += std::acos(std::clamp((trace - 1) / 2, -1.0f, 1.0f));
  }
  return sum / (kJointCount - 1);
}

/// The cheapest way to a pair of frames: what it cost, and how many pairs it has.
struct Way {
  double cost = 0, pairs = 0;
  double mean() const { return cost / pairs; }
};

}  // namespace

double aligned_angle_deg(const std::vector<Rotations>& a, const std::vector<Rotations>& b, double fps) {
  const auto from = thinned(a, fps), to = thinned(b, fps);
  if (from.empty() || to.empty()) return std::nan("");
  std::vector<Way> before(to.size()), now(to.size());
  for (size_t i = 0; i < from.size(); ++i) {
    for (size_t k = 0; k < to.size(); ++k) {
      Way best;
      if (i > 0) best = before[k];
      if (k > 0 && (i == 0 || now[k - 1].cost < best.cost)) best = now[k - 1];
      if (i > 0 && k > 0 && before[k - 1].cost <= best.cost) best = before[k - 1];
      now[k] = {best.cost + static_cast<double>(apart(*from[i], *to[k])), best.pairs + 1};
    }
    std::swap(before, now);
  }
  return before.back().mean() * 180 / static_cast<double>(kPi);
}

}  // namespace understudy
