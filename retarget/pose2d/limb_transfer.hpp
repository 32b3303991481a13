// The engine `limbs`: a pose rebuilt from the mid-hip outwards, each bone as much longer as the person's is.
#pragma once

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy {

/// Directions and foreshortening of every bone stay. Eyes and ears go with the head, toes and heels with the
/// leg, hands with the forearm, the face with the head.
class LimbTransfer final : public KeypointTransfer {
 public:
  /// touches: hands that touch the body, or each other, keep touching (keep_touches).
  explicit LimbTransfer(bool touches = true) : touches_(touches) {}
  FlatPose transfer(const FlatPose& source, const Proportions& from, const Proportions& to) override;
  std::string name() const override { return "limbs"; }

 private:
  bool touches_;
};

}  // namespace understudy
