// The network of the part refiner: arms, legs, hands, head and feet on crops of their own.
#pragma once

#include <torch/torch.h>

#include "retarget/networks/part_forward.hpp"
#include "retarget/nn/modules/skeleton_extractor.hpp"

namespace understudy::nn {

/// One kind of part, from what its points look like together.
class PartNetImpl : public torch::nn::Module {
 public:
  /// points [B, rows_of(kind), 3], context [B, kPartContext] -> [B, kPartJoints, kPartNumbers].
  torch::Tensor forward(const torch::Tensor& points, const torch::Tensor& context);

 protected:
  PartNetImpl();
  /// points, context -> [B, 256], rectified
  virtual torch::Tensor look(const torch::Tensor& points, const torch::Tensor& context) = 0;

 private:
  torch::nn::Sequential head_, place_;
};

/// Two levels of a PointNet (Qi et al., CVPR 2017): the second sees each point beside the pooled features of
/// the first.
class PlainPartNetImpl : public PartNetImpl {
 public:
  PlainPartNetImpl();

 private:
  torch::Tensor look(const torch::Tensor& points, const torch::Tensor& context) override;
  torch::nn::Sequential near_, whole_;
};

/// Patches of neighbouring points, each of which sees all others (cut_part_patches).
class PatchPartNetImpl : public PartNetImpl {
 public:
  PatchPartNetImpl();

 private:
  torch::Tensor look(const torch::Tensor& points, const torch::Tensor& context) override;
  torch::nn::Sequential patch_mlp_, position_mlp_;
  torch::nn::Linear patch_out_{nullptr}, told_{nullptr}, widen_{nullptr};
  torch::nn::ModuleList encoder_;
  torch::nn::LayerNorm norm_{nullptr};
};

/// A network for each kind.
class PartRefinerNetImpl : public torch::nn::Module {
 public:
  PartRefinerNetImpl();
  PartNetImpl& of(PartKind kind) { return *nets_[static_cast<int>(kind)]; }

 private:
  std::array<std::shared_ptr<PartNetImpl>, kPartKinds> nets_;
};
TORCH_MODULE(PartRefinerNet);

}  // namespace understudy::nn
