// The engine `lift`: a pose is lifted into space, takes on the other person's bones there and is seen again.
#pragma once

#include <memory>

#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/pipeline/lifter.hpp"
#include "retarget/pose2d/limb_transfer.hpp"

namespace understudy {

/// Bones of the first 15 points lie as lifted and are as long as the person's, whatever the source's lengths;
/// they are seen from afar, by the camera's axes. Of them, what a picture cut off or a detector missed is made
/// up with low confidence. Eyes, ears, toes, heels, hands and face go with them as by LimbTransfer. Poses come
/// in their order: it remembers.
class LiftTransfer final : public KeypointTransfer {
 public:
  /// touches: see LimbTransfer; dt: seconds between poses. Throws Error without a lifter.
  LiftTransfer(std::unique_ptr<Lifter> lifter, bool touches, float dt = 1 / 30.0f);
  /// A pose that cannot be lifted is rebuilt as by LimbTransfer.
  FlatPose transfer(const FlatPose& source, const Proportions& from, const Proportions& to) override;
  std::string name() const override { return "lift"; }

 private:
  std::unique_ptr<Lifter> lifter_;
  LimbTransfer limbs_;  // lets hands go: they are not yet where they will be
  bool touches_;
  float dt_;
};

}  // namespace understudy
