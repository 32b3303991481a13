// The recurrent network of motion transfer: an encoder reads A's joints, a decoder poses B (paper 1,
// section 3.1, after SMRM: Villegas et al., CVPR 2018).
#pragma once

#include <torch/torch.h>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kMotionGruVersion = 1;

struct MotionGruOptions {
  int64_t hidden = 192;      ///< width of the recurrent layers
  int64_t layers = 2;        ///< of each recurrent network
  bool quaternions = false;  ///< outputs quaternions: the ablation of 6D
};

/// Input of the network: B sequences of T frames.
struct MotionInput {
  torch::Tensor joints;  ///< [B, T, 22, 3] A's joints, metres; any place and heading
  torch::Tensor leg;     ///< [B, T] A's leg length as known at each frame, metres
  torch::Tensor dt;      ///< [B, T] seconds since the frame before
  torch::Tensor rest;    ///< [B, 22, 3] B's T-pose joints, metres
};

/// State between frames; empty before the first.
struct MotionState {
  torch::Tensor encoder, decoder;  ///< [layers, B, hidden]
  torch::Tensor joints;            ///< [B, 1, 22, 3] the last frame
};

/// Thigh plus shin of bodies [B, 22, 3] in any pose, mean of both sides, [B] in their unit.
torch::Tensor leg_lengths(const torch::Tensor& joints);

/// Heading of each frame as a rotation about y, [B, T, 3, 3]: T-pose's heading is the identity. Taken from
/// the line through hips and shoulders, so that one noisy joint turns it little. No gradient passes through.
torch::Tensor headings(const torch::Tensor& joints);

/// Frame by frame: sees this frame, the one before and its state, so it is causal by construction. It works
/// in the frame's own heading, which is put back exactly: turning the source turns the result.
class MotionGruImpl : public torch::nn::Module {
 public:
  explicit MotionGruImpl(const MotionGruOptions& options = {});

  /// Local rotations of B, [B, T, 22, 3, 3]; goes on from `state` and leaves it after the last frame.
  torch::Tensor forward(const MotionInput& input, MotionState& state);

 private:
  torch::Tensor source_features(const MotionInput& input, const MotionState& state,
                                const torch::Tensor& heading) const;
  torch::Tensor rotations(const torch::Tensor& output) const;

  bool quaternions_;
  torch::nn::Linear embed_source{nullptr}, embed_rest{nullptr};
  torch::nn::GRU encoder{nullptr}, decoder{nullptr};
  torch::nn::Sequential head{nullptr};
};
TORCH_MODULE(MotionGru);

}  // namespace understudy::nn
