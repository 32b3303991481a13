#include "retarget/pose2d/proportion_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr double kShortest = 1e-3, kStep = 0.03;  // pixels; of logarithms
constexpr double kSeenTooLong = 0.006;  // of the stature: a standard deviation of what detectors see too long
constexpr double kNeverSure = 1e-6;     // a point may be anywhere
constexpr double kLeastDoubt = 0.02;    // poses of one person err alike: many of them leave some doubt
constexpr double kMostPoses = 20;       // for the same reason more of them count as so many
constexpr double kBelow = 3, kAbove = 5;  // standard deviations: where lengths are looked for
constexpr int kPlaces = 100;
constexpr uint32_t kOneIn = 50;  // longest ones are not believed

/// Logarithm of a normal density, but for tails that fall as an exponential: networks err.
double log_density(double off) {
  constexpr double kTail = 3;
  const double far = std::abs(off);
  return far < kTail ? -far * far / 2 : kTail * (kTail / 2 - far);
}

/// Logarithm of the chance that a standard normal number lies below z.
double log_chance_below(double z) {
  return std::log(std::max(std::erfc(-z * M_SQRT1_2) / 2, kNeverSure));
}

}  // namespace

int ProportionEstimate::Seen::bin_of(double length) {
  if (!(length > kShortest)) return 0;
  return std::min(static_cast<int>(std::log(length / kShortest) / kStep), kBins - 1);
}

void ProportionEstimate::Seen::add(float length) {
  if (!(static_cast<double>(length) > kShortest)) return;
  const int bin = bin_of(static_cast<double>(length));
  ++counts[static_cast<size_t>(bin)];
  ++all;
  highest = std::max(highest, bin);
}

double ProportionEstimate::Seen::longest() const {
  uint32_t left = all / kOneIn;
  for (int bin = highest; bin >= 0; --bin) {
    const uint32_t here = counts[static_cast<size_t>(bin)];
    if (here > left) return kShortest * std::exp(kStep * (bin + 0.5));
    left -= here;
  }
  return kShortest;
}

double ProportionEstimate::Seen::log_chance(double length, double jitter) const {
  double sum = 0;
  const int lowest = bin_of(length - 4 * jitter);
  for (int bin = highest; bin >= lowest; --bin)
    if (const uint32_t count = counts[static_cast<size_t>(bin)])
      sum += count * log_chance_below((length - kShortest * std::exp(kStep * (bin + 0.5))) / jitter);
  return sum;
}

void ProportionEstimate::push(const FlatPose& pose, const PoseLengths& told) {
  const BoneLengths seen = seen_lengths(pose);
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const int mirror = kFlatBoneMirror[static_cast<size_t>(b)];
    const double doubt = static_cast<double>(std::max(told.doubt[b], 1e-3f)), weight = 1 / (doubt * doubt);
    for (const int side : {b, mirror}) {
      seen_[static_cast<size_t>(side)].add(seen[b]);
      sum_[side] += weight * static_cast<double>(told.log_length[b]);
      weight_[side] += weight;
      if (b == mirror) break;
    }
  }
  ++poses_;
}

/// What was told is a normal distribution of the logarithm; each pose in which the bone is seen,
/// foreshortened or not, makes shorter ones less likely.
ProportionEstimate::LogLength ProportionEstimate::log_length(int bone, double jitter) const {
  const Seen& seen = seen_[static_cast<size_t>(bone)];
  const double share = std::min(1.0, kMostPoses / poses_), told = sum_[bone] / weight_[bone],
               doubt = std::sqrt(1 / (share * weight_[bone]));
  const double first = told - kBelow * doubt,
               last = std::max(told, std::log(seen.longest())) + kAbove * doubt;
  const auto place = [&](size_t k) {
    return first + (last - first) * static_cast<double>(k) / (kPlaces - 1);
  };
  std::array<double, kPlaces> chance{};
  for (size_t k = 0; k < chance.size(); ++k)
    chance[k] = share * seen.log_chance(std::exp(place(k)), jitter) + log_density((place(k) - told) / doubt);
  const double most = *std::max_element(chance.begin(), chance.end());
  double all = 0, sum = 0, squares = 0;
  for (size_t k = 0; k < chance.size(); ++k) {
    const double weight = std::exp(chance[k] - most), x = place(k) - told;
    all += weight, sum += weight * x, squares += weight * x * x;
  }
  const double mean = sum / all;
  return {told + mean, std::sqrt(std::max(squares / all - mean * mean, kLeastDoubt * kLeastDoubt))};
}

Proportions ProportionEstimate::lengths() const {
  US_CHECK(poses_ > 0, "nobody was seen whose proportions could be told");
  Proportions result;
  result.poses = poses_;
  result.length = (sum_ / weight_).exp().cast<float>();
  const double jitter = kSeenTooLong * static_cast<double>(stature_of(result.length));
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const LogLength bone = log_length(b, jitter);
    result.length[b] = static_cast<float>(std::exp(bone.mean));
    result.doubt[b] = static_cast<float>(bone.doubt);
  }
  return result;
}

}  // namespace understudy
