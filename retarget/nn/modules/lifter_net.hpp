// The network that lifts 2D poses into space, as it is trained; retarget/networks/lifter_network runs it.
#pragma once

#include <torch/torch.h>

#include "retarget/networks/lifter_network.hpp"

namespace understudy::nn {

/// An embedding of the frame, a recurrent layer (GRU), and two layers on both. Causal by construction.
class LifterNetImpl : public torch::nn::Module {
 public:
  LifterNetImpl();
  struct Lifted {
    torch::Tensor joints;   ///< [B, T, 22, 3] around the middle of the hips, of the person's size
    torch::Tensor log_off;  ///< [B, T, 22] logarithm of how far each is off, the same unit
    torch::Tensor turns;    ///< [B, T, 22, 6] rotations of the joints' frames in the camera's axes
    torch::Tensor pitch;    ///< [B, T] sine of the camera's
  };
  /// frames [B, T, kLiftInputs]; state [1, B, hidden] or undefined before the first frame, left after the
  /// last.
  Lifted forward(const torch::Tensor& frames, torch::Tensor& state);

 private:
  torch::nn::Linear embed, head, last;
  torch::nn::GRU memory;
};
TORCH_MODULE(LifterNet);

}  // namespace understudy::nn
