// The paper's form of skeleton extraction: Point Transformer features, pooled, and an MLP (paper 1,
// section 3.1; Zhao et al., ICCV 2021). The ablation of the dense network.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

/// Vector self-attention among the k nearest points (Zhao et al., eq. 3):
/// y_i = sum_k softmax(gamma(phi(x_i) - psi(x_k) + delta)) * (alpha(x_k) + delta), delta = theta(p_i - p_k).
class VectorAttentionImpl : public torch::nn::Module {
 public:
  explicit VectorAttentionImpl(int64_t width);
  /// x [B, N, C], positions [B, N, 3], neighbours [B, N, k] int64 -> [B, N, C]
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& positions,
                        const torch::Tensor& neighbours);

 private:
  torch::nn::Linear phi{nullptr}, psi{nullptr}, alpha{nullptr}, out{nullptr};
  torch::nn::Sequential gamma{nullptr}, theta{nullptr};
  torch::nn::LayerNorm norm{nullptr};
};
TORCH_MODULE(VectorAttention);

class PointTransformerImpl : public torch::nn::Module {
 public:
  PointTransformerImpl();
  /// points [B, N, 3], normalised -> joints [B, 22, 3]. Order-free.
  torch::Tensor forward(const torch::Tensor& points);

 private:
  torch::nn::Sequential embed{nullptr}, head{nullptr};
  torch::nn::ModuleList attention{nullptr}, widen{nullptr};
};
TORCH_MODULE(PointTransformer);

}  // namespace understudy::nn
