// The network that finds a kind's keypoints in one scan: slots that share out the points of the body, each a
// place and a turn. Learnt without labels.
#pragma once

#include <torch/torch.h>

#include "retarget/geometry/mesh.hpp"

namespace understudy::nn {

constexpr int kSlotPoints = 512;      ///< of a scan that the network sees
constexpr int kSlotPatches = 64;      ///< patch centres, far apart
constexpr int kSlotPatchPoints = 16;  ///< nearest points of each centre

/// B scans, normalised: less the mean of their points, over one scale a sequence.
struct SlotInput {
  torch::Tensor points;   ///< [B, N, 3]
  torch::Tensor centres;  ///< [B, M, 3]
  torch::Tensor offsets;  ///< [B, M, P, 3] the patches' points less their centres
};
/// Version of the network's form.
constexpr int kSlotVersion = 1;
/// Room for B scans.
SlotInput empty_slot_input(int64_t scans);
/// Cuts kSlotPoints normalised points into row `row`.
void put_slot_points(const Points& points, int64_t row, SlotInput& input);

/// In the normalised frame.
struct SlotOutput {
  torch::Tensor heading;  ///< [B, 2] where the body faces, x and z, unit length
  torch::Tensor places;   ///< [B, K, 3]
  torch::Tensor turns;    ///< [B, K, 3, 3] against a pose common to all bodies
  torch::Tensor shares;   ///< [B, N, K] of the points, the nearer ones' more; sum to 1
};

/// Patches with what is about them, by a transformer whose tokens like near ones.
class SlotEncoderImpl : public torch::nn::Module {
 public:
  SlotEncoderImpl(int64_t layers, int64_t width);
  /// centres [B, M, 3], offsets [B, M, P, 3] -> [B, M, width]
  torch::Tensor forward(const torch::Tensor& centres, const torch::Tensor& offsets);

 private:
  torch::nn::Sequential patch_mlp{nullptr}, position_mlp{nullptr};
  torch::nn::Linear patch_out{nullptr};
  torch::nn::ModuleList layers_{nullptr};
  torch::nn::LayerNorm norm{nullptr};
};
TORCH_MODULE(SlotEncoder);

/// Where a body faces. What it looks at does not change when the body turns about the vertical, and what it
/// adds up are directions that turn with it: so its answer turns exactly as the body does.
class HeadingNetImpl : public torch::nn::Module {
 public:
  HeadingNetImpl();
  /// centres [B, M, 3], offsets [B, M, P, 3] -> [B, 2] x and z, unit length
  torch::Tensor forward(const torch::Tensor& centres, const torch::Tensor& offsets);

 private:
  torch::nn::Sequential patch_mlp{nullptr}, place_mlp{nullptr};
  torch::nn::Linear patch_out{nullptr}, weigh{nullptr};
  torch::nn::ModuleList layers_{nullptr};
  torch::nn::LayerNorm norm{nullptr};
};
TORCH_MODULE(HeadingNet);

/// First where the body faces, then all else as if it faced +z.
class SlotNetImpl : public torch::nn::Module {
 public:
  explicit SlotNetImpl(int64_t slots);
  SlotOutput forward(const SlotInput& input);
  int64_t slots() const { return slots_; }

  /// How well slots have carried each other so far, a running mean: `missed` [K', K] how far k' takes k from
  /// where it is (see training::missed_by), `apart` [K', K] how far they are apart.
  void learn_links(const torch::Tensor& missed, const torch::Tensor& apart);
  /// [K', K] what it costs that k hangs on k': the less, the better k' carries it and the nearer it is.
  torch::Tensor link_costs() const;

 private:
  int64_t slots_;
  HeadingNet heading{nullptr};
  SlotEncoder encoder{nullptr};
  torch::nn::Sequential slot_head{nullptr};
  torch::nn::Linear choice_head{nullptr};
  torch::Tensor slot_embedding, missed_, apart_, seen_;  // the links' sums, and the sum of their weights
};
TORCH_MODULE(SlotNet);

}  // namespace understudy::nn
