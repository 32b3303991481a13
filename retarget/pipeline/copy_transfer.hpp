// The analytic engine `copy`: each bone's rotation solved from the source's joint positions, then copied.
#pragma once

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

using JointWeights = Eigen::Array<float, kJointCount, 1>;

/// How `copy` weighs what positions say against what the extractor saw on the surface.
struct CopyOptions {
  CopyOptions();
  /// Weight of the seen rotation (Extraction::global) against the one solved from positions, 0..1 a joint. It
  /// is multiplied by the joint's confidence where `trust_confidence`.
  JointWeights seen;
  /// How far each bone is then turned to lie along the positions, 0..1 a joint: 1 leaves only the twist about
  /// the bone to the seen rotation. Pelvis, spine3 and leaves have no one bone and ignore it.
  JointWeights point;
  bool trust_confidence = false;  ///< whether a seen rotation weighs less where its joint's confidence is low
  float shoulder_hint = 0.3f;  ///< weight of the shoulders in the chest's rotation (neck and collars weigh 1)
  float spine_hint = 0.1f;  ///< weight of spine2 and spine3 in the pelvis' rotation (hips and spine1 weigh 1)
  float rest_blend = 0.0f;  ///< the source's T-pose directions: 0 a mean human's, 1 the target's
  float bend_low_deg = 10.0f;   ///< below this bend the limb's hinge axis is unknown and the last one is kept
  float bend_high_deg = 35.0f;  ///< above this bend the hinge axis is believed at once
  float relax_s = 2.0f;         ///< time in which a kept hinge axis falls back to the T-pose's
};

/// Paper 1's task without a network: the honest baseline. Rotations are relative to the T-pose; the source's
/// own T-pose is unknown, so its bones are taken to have the directions of a mean human's (human_rest).
class CopyTransfer final : public MotionTransfer {
 public:
  explicit CopyTransfer(const CopyOptions& options = {});
  void reset(const Joints& rest_b) override;
  /// Equivariant to the source's heading and place; independent of its size. Throws Error when a joint is not
  /// finite.
  Rotations push(const Extraction& source, float dt) override;
  std::any memory() const override { return memory_; }
  void restore(const std::any& memory) override { memory_ = std::any_cast<const Memory&>(memory); }
  std::string name() const override { return "copy"; }

 private:
  struct Memory {
    Rotations last = identity_rotations();  // local rotations of the last frame
    bool started = false;
  };
  struct Limb;
  struct Frame;
  void solve_trunk(Frame& frame) const;
  void solve_limb(Frame& frame, const Limb& limb);
  /// The rotation of joint j from what positions say (`solved`), what was seen and where its bone points.
  void settle(Frame& frame, int j, const Mat3& solved) const;
  void point_bone(Frame& frame, int j, float amount) const;
  Mat3 hinge_rotation(const Frame& frame, const Limb& limb) const;

  CopyOptions options_;
  Joints rest_;  // the source's assumed T-pose
  Memory memory_;
};

}  // namespace understudy
