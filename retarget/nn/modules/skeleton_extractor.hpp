// The skeleton extraction network. Every patch of the scan predicts its body part and votes for every joint;
// the votes are averaged with learned weights, and a decoder over the joints corrects them and predicts their
// rotations.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

/// B scans as the network sees them, normalised (ScanPatches): all points [B, N, 3], patch centres [B, M, 3],
/// and the points of each patch minus its centre [B, M, K, 3]. For streams also the frame before, in the
/// same frame of reference: joints and their displacement since the one before that [B, 22, 6], and whether
/// either is known, 1 or 0 [B, 2]; undefined for scans of no stream.
struct ExtractorInput {
  torch::Tensor points, centres, offsets;
  torch::Tensor recent, recent_known;
};

/// Output for B scans in the normalised frame of ScanPatches; undefined where a form lacks it.
struct ExtractorOutput {
  torch::Tensor parts;       ///< [B, M, 23] logits: 22 parts, and "not the body"
  torch::Tensor votes;       ///< [B, M, 22, 3] where each patch believes each joint
  torch::Tensor voted;       ///< [B, 22, 3] softmax-weighted votes
  torch::Tensor joints;      ///< [B, 22, 3] after the decoder
  torch::Tensor rotations;   ///< [B, 22, 6] world rotations relative to the T-pose
  torch::Tensor log_spread;  ///< [B, 22] log of the expected error (normalised units)
  torch::Tensor visibility;  ///< [B, 22] logits: whether the scan shows the surface about the joint
};

/// [B, Q, 3], [B, K, 3] -> [B, Q, K]
torch::Tensor squared_distance(const torch::Tensor& a, const torch::Tensor& b);

/// Multi-head attention with a learned preference for near tokens: score -= softplus(a_head) * distance^2.
class DistanceAttentionImpl : public torch::nn::Module {
 public:
  DistanceAttentionImpl(int64_t width, int64_t heads);
  /// q, k, v [B, Q or K, width]; squared_distance [B, Q, K] -> [B, Q, width]
  torch::Tensor forward(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v,
                        const torch::Tensor& squared_distance);

 private:
  int64_t heads_;
  torch::nn::Linear to_q{nullptr}, to_k{nullptr}, to_v{nullptr}, to_out{nullptr};
  torch::Tensor nearness;
};
TORCH_MODULE(DistanceAttention);

class FeedForwardImpl : public torch::nn::Module {
 public:
  explicit FeedForwardImpl(int64_t width);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::nn::Linear up{nullptr}, down{nullptr};
};
TORCH_MODULE(FeedForward);

class EncoderLayerImpl : public torch::nn::Module {
 public:
  EncoderLayerImpl(int64_t width, int64_t heads);
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& position,
                        const torch::Tensor& squared_distance);

 private:
  torch::nn::LayerNorm norm1{nullptr}, norm2{nullptr};
  DistanceAttention attention{nullptr};
  FeedForward feed{nullptr};
};
TORCH_MODULE(EncoderLayer);

class JointDecoderLayerImpl : public torch::nn::Module {
 public:
  JointDecoderLayerImpl();
  /// x, x_position [B, 22, width]; tokens with their position added [B, M, width]
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& x_position, const torch::Tensor& tokens,
                        const torch::Tensor& among, const torch::Tensor& across);

 private:
  torch::nn::LayerNorm norm1{nullptr}, norm2{nullptr}, norm3{nullptr};
  DistanceAttention self_attention{nullptr}, cross_attention{nullptr};
  FeedForward feed{nullptr};
};
TORCH_MODULE(JointDecoderLayer);

class SkeletonExtractorNetImpl : public torch::nn::Module {
 public:
  SkeletonExtractorNetImpl();
  /// Order-free in M and K; uses centres and offsets.
  ExtractorOutput forward(const ExtractorInput& input);

 private:
  torch::Tensor embed_patches(const torch::Tensor& offsets);
  void decode(const torch::Tensor& tokens, const ExtractorInput& input, const torch::Tensor& choice,
              ExtractorOutput& out);
  torch::Tensor embed_recent(const ExtractorInput& input, const torch::Tensor& voted);

  torch::nn::Sequential patch_mlp{nullptr}, position_mlp{nullptr}, recent_mlp{nullptr}, vote_head{nullptr},
      joint_head{nullptr};
  torch::nn::Linear patch_out{nullptr}, visibility_head{nullptr};
  torch::nn::ModuleList encoder{nullptr}, decoder{nullptr};
  torch::nn::LayerNorm token_norm{nullptr}, joint_norm{nullptr};
  torch::Tensor joint_embedding;
};
TORCH_MODULE(SkeletonExtractorNet);

}  // namespace understudy::nn
