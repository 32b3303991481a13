// The loss of motion transfer on a batch (paper 1, eq. 2): unpaired, in a cycle from A to B and back.
#pragma once

#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/motion_data.hpp"

namespace understudy::training {

/// Tells captured motions from made ones: convolutions over time on joints and velocities of a body in its
/// own heading (paper 1, L_adv; after SMRM).
class MotionDiscriminatorImpl : public torch::nn::Module {
 public:
  explicit MotionDiscriminatorImpl(int64_t width = 96);

  /// Scores [B], about 1 for a captured motion and 0 for a made one. joints [B, T, 22, 3] metres, T >= 2;
  /// the body's T-pose joints [B, 22, 3]; dt [B, T] seconds since the frame before.
  torch::Tensor forward(const torch::Tensor& joints, const torch::Tensor& rest, const torch::Tensor& dt);

 private:
  torch::nn::Conv1d first{nullptr}, second{nullptr}, third{nullptr};
  torch::nn::Linear score{nullptr};
};
TORCH_MODULE(MotionDiscriminator);

/// Of the terms beside the cycle's.
struct MotionLossWeights {
  double rotation = 0.01;     ///< lambda_rot
  double smoothness = 0.1;    ///< lambda_smooth
  double adversarial = 1e-4;  ///< joints are in metres here; the paper names no unit for its weight of 1
};

struct MotionStep {
  LossSum loss;
  /// [crossed, T, 22, 3] joints of the motions on other bodies, the pelvis at the origin
  torch::Tensor made;
};

MotionStep motion_step(nn::MotionGru& net, MotionDiscriminator& discriminator, const MotionBatch& batch,
                       const MotionLossWeights& weights);

}  // namespace understudy::training
