// The network that corrects a smooth curve through known poses: deep delta interpolation (Oreshkin et al.
// 2022), for a window of up to four seconds with any of its frames and parts known.
#pragma once

#include <torch/torch.h>

#include "retarget/motion_space/motion_window.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kInbetweenVersion = 1;

struct InbetweenOptions {
  int64_t width = 192, inner = 512;  ///< of a frame, and inside each layer
  int64_t layers = 6, heads = 6;
};

/// B windows of T frames at 30 frames/s, seen from their outlooks.
struct InbetweenInput {
  torch::Tensor rotations;  ///< [B, T, 22, 3, 3] local, of the curve
  torch::Tensor root;       ///< [B, T, 3] of the curve, metres
  torch::Tensor distance;   ///< [B, T, 23, 2] see KnownDistance
  torch::Tensor rest;       ///< [B, 22, 3] the body's T-pose joints, metres
};

struct InbetweenOutput {
  torch::Tensor rotations;  ///< [B, T, 22, 3, 3]; what is known is the curve's to the bit
  torch::Tensor root;       ///< [B, T, 3] metres
  torch::Tensor standing;   ///< [B, T, 2] logits that the left and right foot stand
  torch::Tensor doubt;      ///< [B, T] logarithm of the expected mean error of joints in metres
};

/// A frame sees all others, weighed by what they are and by how far away they are. It begins as the curve:
/// what it adds is zero before training, and fades where something is known.
class InbetweenNetImpl : public torch::nn::Module {
 public:
  explicit InbetweenNetImpl(const InbetweenOptions& options = {});
  InbetweenOutput forward(const InbetweenInput& input);

 private:
  torch::Tensor features(const InbetweenInput& input) const;
  torch::Tensor attended(const torch::Tensor& x, size_t layer);
  torch::Tensor nearness(int64_t frames, size_t layer) const;

  InbetweenOptions options_;
  torch::nn::Linear embed{nullptr}, head{nullptr};
  torch::nn::LayerNorm last_norm{nullptr};
  torch::nn::ModuleList attention_norm, query_key_value, mixed, inner_norm, widen, narrow;
  torch::nn::ParameterList by_distance;  // [heads, 2 kMostApart + 1] a layer
};
TORCH_MODULE(InbetweenNet);

}  // namespace understudy::nn
