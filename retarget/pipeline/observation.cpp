#include "retarget/pipeline/observation.hpp"

#include <algorithm>
#include <utility>

#include "retarget/base/text.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy {
namespace {

constexpr float kLeastConfidence = 0.08f;  // mean over joints that are seen

}  // namespace

Observation without_skeleton(std::string problem) {
  Observation nothing;
  nothing.confidence.setZero();
  nothing.problem = std::move(problem);
  return nothing;
}

bool finite(const Rotations& rotations) {
  return std::all_of(rotations.begin(), rotations.end(), [](const Mat3& R) { return R.allFinite(); });
}

std::string refusal(const Observation& seen) {
  if (!seen.problem.empty()) return seen.problem;
  if (!seen.joints.allFinite() || !seen.confidence.allFinite() || (seen.global && !finite(*seen.global)))
    return "the extracted skeleton has numbers that are not finite";
  const float confidence = mean_confidence(seen);
  if (confidence < kLeastConfidence)
    return "the confidence in the skeleton is only " + short_number(static_cast<double>(confidence));
  return {};
}

}  // namespace understudy
