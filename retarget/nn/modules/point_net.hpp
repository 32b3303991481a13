// PointNet as skeleton extraction: each point alone, then the maximum over all points, and an MLP (Qi et al.,
// CVPR 2017, without the alignment networks). The ablation of local features.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

class PointNetImpl : public torch::nn::Module {
 public:
  PointNetImpl();
  /// points [B, N, 3], normalised -> joints [B, 22, 3]. Order-free.
  torch::Tensor forward(const torch::Tensor& points);

 private:
  torch::nn::Sequential each_point{nullptr}, head{nullptr};
};
TORCH_MODULE(PointNet);

}  // namespace understudy::nn
