// The network that sees arms, legs, hands, head and feet from near.
#pragma once

#include <torch/torch.h>

#include "retarget/networks/part_crops.hpp"

namespace understudy::nn {

constexpr int kPartVersion = 2;
constexpr const char* kPartFileKind = "leaf";  ///< as its files have it
/// Of a joint: a rotation in the crop's frame as 6D, the way from where it was seen to where it is and the
/// log of the error to expect of that, both in leg lengths.
constexpr int kPartNumbers = 10;

/// Two levels of a PointNet (Qi et al., CVPR 2017) over one kind of part: the second sees each point beside
/// what the first found in all of them.
class PartNetImpl : public torch::nn::Module {
 public:
  PartNetImpl();
  /// points [B, kPartPoints, 3], context [B, kPartContext] -> [B, kPartJoints, kPartNumbers].
  torch::Tensor forward(const torch::Tensor& points, const torch::Tensor& context);

 private:
  torch::nn::Sequential near_, whole_, head_, place_;
};
TORCH_MODULE(PartNet);

/// One PartNet a kind.
class PartRefinerNetImpl : public torch::nn::Module {
 public:
  PartRefinerNetImpl();
  PartNet& of(PartKind kind) { return nets_[static_cast<int>(kind)]; }

 private:
  std::array<PartNet, kPartKinds> nets_;
};
TORCH_MODULE(PartRefinerNet);

}  // namespace understudy::nn
