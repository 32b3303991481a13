// The analytic engines `copy` and `positions`: each bone's rotation solved from the source's joints,
// then copied.
#pragma once

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// Paper 1's task without a network: the honest baseline. Rotations are relative to the T-pose; the source's
/// own T-pose is unknown, so its bones are taken to have the directions of a mean human's (human_rest).
class CopyTransfer final : public MotionTransfer {
 public:
  /// `sees_rotations`: whether the rotations that the extractor saw on the surface count, too. Without them
  /// it is the engine `positions`, which knows what paper 1's input holds: twists, head,
  /// hands and feet are guessed.
  explicit CopyTransfer(bool sees_rotations = true) : sees_rotations_(sees_rotations) {}
  void reset(const Joints& rest_b) override;
  /// Equivariant to the source's heading and place; independent of its size. Throws Error when a joint is not
  /// finite.
  Rotations push(const Extraction& source, float dt) override;
  std::any memory() const override { return memory_; }
  void restore(const std::any& memory) override { memory_ = std::any_cast<const Memory&>(memory); }
  std::string name() const override { return sees_rotations_ ? "copy" : "positions"; }

 private:
  struct Memory {
    Rotations last = identity_rotations();  // local rotations of the last frame
    bool started = false;
  };
  struct Limb;
  struct Frame;
  void solve_trunk(Frame& frame) const;
  void solve_limb(Frame& frame, const Limb& limb);
  /// The rotation of joint j from positions (`solved`), what was seen and where its bone points.
  void settle(Frame& frame, int j, const Mat3& solved) const;
  void point_bone(Frame& frame, int j, float amount) const;
  Mat3 hinge_rotation(const Frame& frame, const Limb& limb) const;

  bool sees_rotations_;
  Memory memory_;
};

}  // namespace understudy
