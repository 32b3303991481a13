// The network of the part refiner: arms, legs, hands, head and feet on crops of their own.
#pragma once

#include <torch/torch.h>

#include "retarget/networks/part_forward.hpp"

namespace understudy::nn {

/// Two levels of a PointNet (Qi et al., CVPR 2017) over one kind of part: the second sees each point beside
/// the pooled features of the first.
class PartNetImpl : public torch::nn::Module {
 public:
  PartNetImpl();
  /// points [B, kPartPoints, 3], context [B, kPartContext] -> [B, kPartJoints, kPartNumbers].
  torch::Tensor forward(const torch::Tensor& points, const torch::Tensor& context);

 private:
  torch::nn::Sequential near_, whole_, head_, place_;
};
TORCH_MODULE(PartNet);

/// A PartNet for each kind.
class PartRefinerNetImpl : public torch::nn::Module {
 public:
  PartRefinerNetImpl();
  PartNet& of(PartKind kind) { return nets_[static_cast<int>(kind)]; }

 private:
  std::array<PartNet, kPartKinds> nets_;
};
TORCH_MODULE(PartRefinerNet);

}  // namespace understudy::nn
