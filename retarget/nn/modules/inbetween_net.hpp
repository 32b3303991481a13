// The network that corrects a smooth curve through known poses: deep delta interpolation (Oreshkin et al.
// 2022), for a window of up to four seconds with any of its frames and parts known.
#pragma once

#include <torch/torch.h>

#include "retarget/motion_space/motion_window.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kInbetweenVersion = 1;
/// How the names begin of what codes movements; weights from before that lack it.
constexpr const char* kMovementCodes = "movement_";

/// A row of transformer layers.
struct WindowLayers {
  int64_t width = 192, inner = 512;  ///< of a frame, and inside each layer
  int64_t layers = 6, heads = 6;
};

struct InbetweenOptions : WindowLayers {
  int64_t code = 16;                       ///< numbers of a movement's code; even
  WindowLayers encoder = {80, 192, 2, 4};  ///< what finds it
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

/// Which of many movements a window is: each number of a standard normal distribution.
struct MovementCode {
  torch::Tensor mean, log_deviation;  ///< [B, InbetweenOptions::code]
};

/// Codes [B, C] of the movements in a mirror: the second half of the numbers changes its sign.
torch::Tensor code_in_mirror(const torch::Tensor& code);

/// A frame sees all others, weighed by what they are and by how far away they are.
class WindowTransformerImpl : public torch::nn::Module {
 public:
  WindowTransformerImpl(const WindowLayers& form, int64_t outputs);
  /// [B, T, outputs] of a window; `added` [B, 1, width] joins every frame's features, where it is defined.
  torch::Tensor forward(const InbetweenInput& input, const torch::Tensor& added = {});

 private:
  torch::Tensor features(const InbetweenInput& input) const;
  torch::Tensor attended(const torch::Tensor& x, size_t layer);
  torch::Tensor nearness(int64_t frames, size_t layer) const;

  WindowLayers form_;
  torch::nn::Linear embed{nullptr};
  torch::nn::LayerNorm last_norm{nullptr};
  torch::nn::ModuleList attention_norm, query_key_value, mixed, inner_norm, widen, narrow;
  torch::nn::ParameterList by_distance;  // [heads, 2 kMostApart + 1] a layer

 protected:
  torch::nn::Linear head{nullptr};
};
TORCH_MODULE(WindowTransformer);

/// It begins as the curve: what it adds is zero before training, and fades where something is known. Told a
/// code, it makes the movement of that code; untold, the mean of what may be.
class InbetweenNetImpl : public WindowTransformerImpl {
 public:
  explicit InbetweenNetImpl(const InbetweenOptions& options = {});
  /// `code`: [B, code], or undefined; `told`: [B, 1], 0 where a window's code is not to be looked at.
  InbetweenOutput forward(const InbetweenInput& input, const torch::Tensor& code = {},
                          const torch::Tensor& told = {});
  /// Of wholly known movements (distance is not looked at).
  MovementCode encode(InbetweenInput movement);

 private:
  int64_t code_size_;
  WindowTransformer movement_encoder{nullptr};
  torch::nn::Linear movement_told{nullptr};
};
TORCH_MODULE(InbetweenNet);

}  // namespace understudy::nn
