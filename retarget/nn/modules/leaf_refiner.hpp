// The network that sees arms, legs, hands, head and feet from near.
#pragma once

#include <torch/torch.h>

#include "retarget/nn/leaf_crops.hpp"

namespace understudy::nn {

constexpr int kLeafVersion = 2;
/// Of a joint: a rotation in the crop's frame as 6D, the way from where it was seen to where it is and the
/// log of the error to expect of that, both in leg lengths.
constexpr int kLeafNumbers = 10;

/// Two levels of a PointNet (Qi et al., CVPR 2017) over one kind of leaf: the second sees each point beside
/// what the first found in all of them.
class LeafNetImpl : public torch::nn::Module {
 public:
  LeafNetImpl();
  /// points [B, kLeafPoints, 3], context [B, kLeafContext] -> [B, kLeafJoints, kLeafNumbers].
  torch::Tensor forward(const torch::Tensor& points, const torch::Tensor& context);

 private:
  torch::nn::Sequential near_, whole_, head_, place_;
};
TORCH_MODULE(LeafNet);

/// One LeafNet a kind.
class LeafRefinerNetImpl : public torch::nn::Module {
 public:
  LeafRefinerNetImpl();
  LeafNet& of(LeafKind kind) { return nets_[static_cast<size_t>(kind)]; }

 private:
  std::array<LeafNet, kLeafKinds> nets_;
};
TORCH_MODULE(LeafRefinerNet);

}  // namespace understudy::nn
