#include "retarget/pipeline/person_check.hpp"

#include <cmath>

#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr float kImplausible = 0.25f,
                kOdd = 0.17f;            // bones that are no person's, and that are unsure to be one's
constexpr float kUnsure = 0.6f;          // confidence
constexpr int kFewest = 3, kFirst = 60;  // frames that are looked at

}  // namespace

float bone_implausibility(const Joints& joints) {
  using Lengths = Eigen::Array<float, kJointCount - 1, 1>;
  const Lengths lengths = bone_lengths(joints).tail<kJointCount - 1>();
  const Lengths human = bone_lengths(human_rest()).tail<kJointCount - 1>();
  const Lengths ratio = (lengths.max(1e-6f) / human).log();
  return std::sqrt((ratio - ratio.mean()).square().mean());
}

std::string PersonCheck::push(const Extraction& seen) {
  if (seen.exact || told_ || frames_ >= kFirst || !seen.joints.allFinite()) return {};
  const float strange = bone_implausibility(seen.joints);
  ++frames_;
  if (strange > kImplausible || (strange > kOdd && seen.confidence.mean() < kUnsure)) ++implausible_;
  told_ = frames_ >= kFewest && implausible_ * 5 >= frames_ * 4;
  if (!told_) return {};
  return "may be no person, or one whose poses are not recognised: the bones found in " +
         std::to_string(implausible_) + " of its first " + std::to_string(frames_) + " frames are nobody's";
}

}  // namespace understudy
