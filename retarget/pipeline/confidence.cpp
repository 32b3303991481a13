#include "retarget/pipeline/confidence.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kHalfConfidence = 0.06f;  // metres

}  // namespace

float expected_error_for(float confidence) {
  return kHalfConfidence * std::sqrt(1 / std::clamp(confidence, 1e-6f, 1.0f) - 1);
}

float confidence_for(float expected_error_m) {
  const float expected = expected_error_m / kHalfConfidence;
  return 1 / (1 + expected * expected);
}

}  // namespace understudy
