// What a joint's confidence stands for.
#pragma once

#include <algorithm>
#include <cmath>

namespace understudy {

constexpr float kHalfConfidence = 0.06f;  ///< metres

/// Confidence, 0..1, of a joint that is expected to be off by so many metres: one half at kHalfConfidence.
inline float confidence_for(float expected_error_m) {
  const float expected = expected_error_m / kHalfConfidence;
  return 1 / (1 + expected * expected);
}
/// The error that a confidence stands for, metres.
inline float expected_error_for(float confidence) {
  return kHalfConfidence * std::sqrt(1 / std::clamp(confidence, 1e-6f, 1.0f) - 1);
}

}  // namespace understudy
