// The loss of motion transfer on a batch (paper 1, eq. 2): unpaired, in a cycle from A to B and back.
#pragma once

#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/motion_data.hpp"
#include "retarget/training/motion_discriminator.hpp"

namespace understudy::training {

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
