#include "retarget/pose2d/growth_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr double kMemory_s = 0.5;
constexpr double kMost = 2.302585;  // logarithm of ten

}  // namespace

float GrowthEstimate::push(const PoseLengths& told, const Proportions& lengths, double dt) {
  double sum = 0, weights = 0;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const double doubt = std::max(static_cast<double>(told.doubt[b]), 1e-3), weight = 1 / (doubt * doubt);
    sum += weight * (static_cast<double>(told.log_length[b]) -
                     std::log(std::max(static_cast<double>(lengths.length[b]), 1e-6)));
    weights += weight;
  }
  const double now = std::clamp(sum / weights, -kMost, kMost);
  const double share = started_ ? 1 - std::exp(-dt / kMemory_s) : 1;
  started_ = true;
  growth_ += share * (now - growth_);
  return growth();
}

float GrowthEstimate::growth() const {
  return static_cast<float>(std::exp(growth_));
}

}  // namespace understudy
