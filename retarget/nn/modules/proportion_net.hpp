// The network that reads lengths off a 2D pose, as it is trained; retarget/networks/length_reader runs it.
#pragma once

#include <torch/torch.h>

#include "retarget/networks/length_reader.hpp"

namespace understudy::nn {

/// Four linear layers with ReLU between them.
class ProportionNetImpl : public torch::nn::Module {
 public:
  ProportionNetImpl();
  struct Lengths {
    torch::Tensor log_length;  ///< [B, 14] of the pose's size
    torch::Tensor log_doubt;   ///< [B, 14] logarithm of its standard deviation
  };
  /// poses [B, kProportionInputs]
  Lengths forward(const torch::Tensor& poses);

 private:
  torch::nn::Linear first, second, third, last;
};
TORCH_MODULE(ProportionNet);

}  // namespace understudy::nn
