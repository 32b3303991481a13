// Whether a confidence predicts the error.
#pragma once

#include <cstdint>
#include <vector>

namespace understudy {

/// Spearman's rank correlation of two equally long lists, ties at their mean rank; NaN with fewer than 3 or
/// when one of them does not vary.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// The rank correlation that expected errors would have with errors drawn from exactly them, normal and alike
/// along all axes: what is left to chance where nothing is wrong with what is expected.
double best_rank_correlation(const std::vector<double>& expected);

/// One bin of a reliability table.
struct ReliabilityBin {
  double confidence = 0;  ///< mean
  double error = 0;       ///< mean
  double p90 = 0;         ///< the error that 90 % stay below
  int64_t count = 0;
};
/// Bins of (nearly) equally many samples in rising order of confidence; at most `bins`.
std::vector<ReliabilityBin> reliability(const std::vector<double>& confidence,
                                        const std::vector<double>& error, int bins = 10);

}  // namespace understudy
