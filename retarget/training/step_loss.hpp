// The loss of steps that are coded and decoded, on a batch (paper 2, section 3.3).
#pragma once

#include "retarget/nn/modules/step_cvae.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/losses/step_losses.hpp"
#include "retarget/training/step_data.hpp"

namespace understudy::training {

struct StepLossOptions {
  double kl = 0.01;         ///< w_KL of eq. 4 and 5
  bool on_surface = false;  ///< phase 2 (eq. 5) instead of phase 1 (eq. 4)
  bool balance = false;     ///< brings the weights of the losses up to date first
};

/// The weights of phase 1's losses of pose, path and time, and of phase 2's of vertices and time.
struct StepBalances {
  LossBalance numbers{3}, surface{2};
};

/// `noise` [B, code], standard normal, draws the codes. `balances` changes where it is to be brought up to
/// date.
LossSum step_loss(nn::StepCvae& net, const StepBatch& batch, const torch::Tensor& noise,
                  const SurfaceDistance& surface, const StepLossOptions& options, StepBalances& balances);

}  // namespace understudy::training
