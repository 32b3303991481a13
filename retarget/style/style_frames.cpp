#include "retarget/style/style_frames.hpp"

#include "retarget/base/error.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {

void StyleFrames::reset() {
  locals_.reset(human_rest());
  for (RunningMedian& length : lengths_) length.clear();
}

StyleFrame StyleFrames::push(const Extraction& seen, float dt) {
  US_CHECK(seen.joints.allFinite() && leg_length(seen.joints) > 1e-4f,
           "the skeleton has no legs to be styled by");
  const auto now = bone_lengths(seen.joints);
  Eigen::Array<float, kJointCount, 1> usual = now, lengths = now;
  for (int j = 1; j < kJointCount; ++j) {
    lengths_[j].push(now[j]);
    usual[j] = lengths_[j].value();
  }
  for (int j = 1; j < kJointCount; ++j) lengths[j] = 0.5f * (usual[j] + usual[kMirror[j]]);
  StyleFrame frame;
  frame.rest = rest_with_lengths(human_rest(), lengths);
  frame.pose = {locals_.push(seen, dt), seen.joints.row(Pelvis).transpose()};
  frame.dt = dt;
  return frame;
}

}  // namespace understudy
