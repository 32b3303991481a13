// The engine `positions`: as `copy`, from the source's joint positions alone.
#pragma once

#include "retarget/pipeline/copy_transfer.hpp"

namespace understudy {

/// What paper 1's input holds: where joints are, not how bones are turned. Their twist, and head, hands and feet,
/// are guessed as CopyTransfer guesses them where no rotation was seen.
class PositionsTransfer final : public MotionTransfer {
 public:
  void reset(const Joints& rest_b) override { copy_.reset(rest_b); }
  Rotations push(const Extraction& source, float dt) override {
    Extraction positions = source;
    positions.global.reset();
    return copy_.push(positions, dt);
  }
  std::any memory() const override { return copy_.memory(); }
  void restore(const std::any& memory) override { copy_.restore(memory); }
  std::string name() const override { return "positions"; }

 private:
  CopyTransfer copy_;
};

}  // namespace understudy
