#include "retarget/metrics/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/math/types.hpp"

namespace understudy {
namespace {

std::vector<size_t> rising(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t k) { return values[i] < values[k]; });
  return order;
}

std::vector<double> ranks(const std::vector<double>& values) {
  const std::vector<size_t> order = rising(values);
  std::vector<double> rank(values.size());
  for (size_t i = 0; i < order.size();) {
    size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (size_t k = i; k < end; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return rank;
}

}  // namespace

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  US_CHECK(a.size() == b.size(), a.size(), " values cannot be compared with ", b.size());
  if (a.size() < 3) return std::nan("");
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double mean = 0.5 * static_cast<double>(a.size() - 1);
  double xy = 0, xx = 0, yy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : std::nan("");
}

double best_rank_correlation(const std::vector<double>& expected) {
  Rng rng(1);
  std::vector<double> drawn;
  drawn.reserve(expected.size());
  for (const double error : expected)
    drawn.push_back(error * Vec3(rng.normal(), rng.normal(), rng.normal()).norm());
  return rank_correlation(expected, drawn);
}

std::vector<ReliabilityBin> reliability(const std::vector<double>& confidence,
                                        const std::vector<double>& error, int bins) {
  US_CHECK(confidence.size() == error.size() && bins > 0, confidence.size(), " confidences for ",
           error.size(), " errors");
  const std::vector<size_t> order = rising(confidence);
  std::vector<ReliabilityBin> table;
  for (int b = 0; b < bins; ++b) {
    const size_t from = order.size() * static_cast<size_t>(b) / static_cast<size_t>(bins);
    const size_t to = order.size() * static_cast<size_t>(b + 1) / static_cast<size_t>(bins);
    if (from == to) continue;
    ReliabilityBin bin;
    std::vector<double> errors;
    for (size_t i = from; i < to; ++i) {
      bin.confidence += confidence[order[i]] / static_cast<double>(to - from);
      bin.error += error[order[i]] / static_cast<double>(to - from);
      errors.push_back(error[order[i]]);
    }
    bin.count = static_cast<int64_t>(errors.size());
    std::sort(errors.begin(), errors.end());
    bin.p90 = errors[(errors.size() - 1) * 9 / 10];
    table.push_back(bin);
  }
  return table;
}

}  // namespace understudy
