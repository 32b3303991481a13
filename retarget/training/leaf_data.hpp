// Crops of arms, legs, hands, heads and feet with what is true of them.
#pragma once

#include <torch/torch.h>

#include <array>

#include "retarget/nn/leaf_crops.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// Of one kind of leaf.
struct LeafBatch {
  torch::Tensor points;   ///< [B, kLeafPoints, 3]
  torch::Tensor context;  ///< [B, kLeafContext]
  torch::Tensor
      truth;  ///< [B, kLeafJoints, 9] rotation and way as LeafNet tells them; what a kind lacks: none
  torch::Tensor before;  ///< [B, kLeafJoints, 9] what would be said without looking
};
using LeafBatches = std::array<LeafBatch, nn::kLeafKinds>;

/// Makes dense scans and pretends an extraction of them whose rotations are wrong as real ones are: partly
/// drawn to what the limb alone suggests, partly at random.
class LeafSampler {
 public:
  LeafSampler(const TrainingData& data, uint64_t seed);
  /// The crops of so many scans.
  LeafBatches next(int scans);

 private:
  Extraction pretend(const PosedSkeleton& truth);

  std::array<ScanMaker, 3> makers_;  // few points, many, very many
  Rng rng_;
};

}  // namespace understudy::training
