// Part crops with labels.
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
  /// [B, kPartJoints, 9] rotation and displacement as in PartNet's output; identity where a kind has none.
  torch::Tensor truth;
  torch::Tensor before;  ///< [B, kPartJoints, 9] the same of the extraction, uncorrected
};
using PartBatches = std::array<PartBatch, nn::kPartKinds>;

/// Makes dense scans and simulates an extraction of them whose rotations are as wrong as real ones: partly
/// pulled to those of the parent, partly at random.
class PartSampler {
 public:
  PartSampler(const TrainingData& data, uint64_t seed);
  /// The crops of that many scans.
  PartBatches next(int scans);

 private:
  Extraction pretend(const PosedSkeleton& truth);

  std::array<ScanMaker, 3> makers_;  // few points, many, very many
  Rng rng_;
};

}  // namespace understudy::training
