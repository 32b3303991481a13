#include "retarget/pose2d/proportion_input.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/seen_points.hpp"

namespace understudy {
namespace {

constexpr float kLeastLooks = 0.01f;  // of the size: shorter bones look alike
constexpr float kLeastSize = 1e-3f;   // pixels

}  // namespace

ProportionInput proportion_input(const FlatPose& seen) {
  const auto [pose, box] = seen_points(seen, 2, "tells no lengths");
  ProportionInput input;
  input.size = box.diagonal().norm();
  US_CHECK(std::isfinite(input.size) && input.size > kLeastSize,
           "a pose whose points are all in one place tells no lengths");

  input.numbers.setZero();
  const Vec2 middle = box.center();
  for (int p = 0; p < kPaperPoints; ++p) {
    if (!pose.has(p)) continue;
    const Vec2 at = (pose.at(p) - middle) / input.size;
    input.numbers.segment<4>(4 * p) << 2 * at.x(), -2 * at.y(), 1, std::min(pose.confidence(p), 1.0f);
  }
  const BoneLengths looks = seen_lengths(pose) / input.size;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const FlatBone& bone = kFlatBones[static_cast<size_t>(b)];
    if (!pose.has(bone.from) || !pose.has(bone.to)) continue;
    input.numbers.segment<2>(4 * kPaperPoints + 2 * b) << 4 * looks[b],
        0.5f * (std::log(looks[b] + kLeastLooks) + 2);
  }
  return input;
}

}  // namespace understudy
