// The discriminator of motion transfer: is a motion captured, or made by the network?
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// Convolutions over time on joints and velocities of a body in its own heading (paper 1, L_adv; after SMRM).
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

}  // namespace understudy::training
