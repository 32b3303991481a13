// The networks of Zheng et al. (2021), as they are trained; retarget/networks/code_transfer runs the
// generator. What the paper does not tell, the sizes and the layers over points, is ours.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/networks/code_transfer.hpp"

namespace understudy::nn {

/// y = within(mix x): over the points, then within each. [B, 15, C]
class CodeLayerImpl : public torch::nn::Module {
 public:
  explicit CodeLayerImpl(int64_t width);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::Tensor mix;
  torch::nn::Linear within;
};
TORCH_MODULE(CodeLayer);

/// G: a pose's code without size (instance normalisation over the points), decoded by blocks whose scales and
/// shifts (AdaIN) come from the person's code.
class PoseCodeGeneratorImpl : public torch::nn::Module {
 public:
  PoseCodeGeneratorImpl();
  /// poses [B, 15, 3] (PoseCodeInput), people [B, 14] (PersonCodeInput): [B, 15, 2] x to the right, y up,
  /// units.
  torch::Tensor forward(const torch::Tensor& poses, const torch::Tensor& people);

 private:
  torch::nn::Linear in, code, first, second, person, style, styles, out, points;
  std::vector<CodeLayer> encoder, decoder;
};
TORCH_MODULE(PoseCodeGenerator);

/// D: a score for each person that is learned from (FUNIT's), and the features that L_F compares.
class PoseCodeDiscriminatorImpl : public torch::nn::Module {
 public:
  explicit PoseCodeDiscriminatorImpl(int64_t people);
  struct Judged {
    torch::Tensor scores;    ///< [B, people]
    torch::Tensor features;  ///< [B, width]
  };
  /// poses [B, 15, 2]; the middle of their box does not count
  Judged forward(const torch::Tensor& poses);

 private:
  torch::nn::Linear first, second, third, last;
};
TORCH_MODULE(PoseCodeDiscriminator);

}  // namespace understudy::nn
