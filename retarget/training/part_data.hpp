// Crops of arms, legs, hands, heads and feet with what is true of them.
#pragma once

#include <torch/torch.h>

#include <array>

#include "retarget/networks/part_crops.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// Of one kind of part.
struct PartBatch {
  torch::Tensor points;   ///< [B, kPartPoints, 3]
  torch::Tensor context;  ///< [B, kPartContext]
  torch::Tensor
      truth;  ///< [B, kPartJoints, 9] rotation and way as PartNet tells them; what a kind lacks: none
  torch::Tensor before;  ///< [B, kPartJoints, 9] what would be said without looking
};
using PartBatches = std::array<PartBatch, nn::kPartKinds>;

/// Makes dense scans and pretends an extraction of them whose rotations are wrong as real ones are: partly
/// drawn to what the limb alone suggests, partly at random.
class PartSampler {
 public:
  PartSampler(const TrainingData& data, uint64_t seed);
  /// The crops of so many scans.
  PartBatches next(int scans);

 private:
  Extraction pretend(const PosedSkeleton& truth);

  std::array<ScanMaker, 3> makers_;  // few points, many, very many
  Rng rng_;
};

}  // namespace understudy::training
