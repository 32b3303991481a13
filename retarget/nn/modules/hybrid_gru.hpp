// The recurrent network of the engine `hybrid`: corrects the rotations of the analytic solve.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/nn/hybrid_frame.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kHybridVersion = 1;

struct HybridGruOptions {
  int64_t hidden = 256;  ///< width of the recurrent layers
  int64_t layers = 1;
};

/// Frames of B sequences of T frames (HybridFrame).
struct HybridInput {
  torch::Tensor joints;        ///< [B, T, 22, 3]
  torch::Tensor leg, dt;       ///< [B, T]
  torch::Tensor confidence;    ///< [B, T, 22]
  torch::Tensor solved, seen;  ///< [B, T, 22, 3, 3] world rotations
  torch::Tensor has_seen;      ///< [B, T] 0 or 1
};

HybridInput stack_frames(const std::vector<std::vector<HybridFrame>>& sequences);
HybridInput to_device(const HybridInput& input, const torch::Device& device);

/// What it remembers between frames; empty: nothing was seen yet.
struct HybridState {
  torch::Tensor hidden;          ///< [layers, B, hidden]
  torch::Tensor joints, solved;  ///< of the last frame, [B, 1, 22, 3] and [B, 1, 22, 3, 3]
};

/// Sees this frame, the one before and its state: causal by construction. It works in the frame's own heading
/// and gives each joint's correction in that joint's own frame, so that turning the source turns the result.
/// What it adds is bounded: no joint is turned by more than some 60 degrees, however long the sequence.
class HybridGruImpl : public torch::nn::Module {
 public:
  explicit HybridGruImpl(const HybridGruOptions& options = {});

  /// World rotations [B, T, 22, 3, 3]; goes on from `state` and leaves it after the last frame. Untrained it
  /// gives the solve's.
  torch::Tensor forward(const HybridInput& input, HybridState& state);

 private:
  torch::nn::Linear embed{nullptr}, last{nullptr};
  torch::nn::GRU gru{nullptr};
  torch::nn::Sequential head{nullptr};
};
TORCH_MODULE(HybridGru);

/// Local rotations from world rotations, [B, T, 22, 3, 3].
torch::Tensor local_rotations(const torch::Tensor& global);

}  // namespace understudy::nn
