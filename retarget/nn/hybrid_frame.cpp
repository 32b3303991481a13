#include "retarget/nn/hybrid_frame.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"

namespace understudy::nn {

void HybridSolve::reset(const Joints& rest_b) {
  copy_.reset(rest_b);
  leg_sum_ = 0;
  frames_ = 0;
}

HybridFrame HybridSolve::push(const Extraction& source, float dt) {
  const float leg = leg_length(source.joints);
  US_CHECK(leg > 1e-3f, "the source's legs have no length");
  HybridFrame frame;
  const Pose solved{copy_.push(source, dt), Vec3::Zero()};
  frame.solved = forward_kinematics(source.joints, solved).global;
  frame.joints = source.joints;
  leg_sum_ += leg;
  frame.leg = static_cast<float>(leg_sum_ / static_cast<double>(++frames_));
  frame.dt = std::clamp(dt, 1.0f / 240, 0.5f);
  frame.confidence = source.confidence;
  frame.has_seen = source.global.has_value();
  frame.seen = frame.has_seen ? *source.global : frame.solved;
  return frame;
}

}  // namespace understudy::nn
