// Part crops with labels.
#pragma once

#include <torch/torch.h>

#include <array>
#include <vector>

#include "retarget/networks/part_crops.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// Of one kind of part.
struct PartBatch {
  torch::Tensor points;   ///< [B, nn::rows_of(kind), 3]
  torch::Tensor context;  ///< [B, kPartContext]
  /// [B, kPartJoints, 9] rotation and displacement as in PartNet's output; identity where a kind has none.
  torch::Tensor truth;
  torch::Tensor before;  ///< [B, kPartJoints, 9] the same of the extraction, uncorrected
};
using PartKinds = std::array<bool, nn::kPartKinds>;  ///< which are wanted
using PartBatches = std::array<PartBatch, nn::kPartKinds>;

/// Makes dense scans and simulates an extraction of them whose rotations are as wrong as real ones: partly
/// pulled to those of the parent, partly at random.
class PartSampler {
 public:
  using Label = Eigen::Matrix<float, 9, 1>;
  struct Crops {
    std::vector<nn::PartCrop> crops;
    std::vector<std::array<Label, nn::kPartJoints>> truth, before;
  };

  PartSampler(const TrainingData& data, const PartKinds& kinds, uint64_t seed);
  /// The crops of that many scans, two of each part; of kinds that are not wanted none.
  PartBatches next(int scans);

 private:
  Extraction pretend(const PosedSkeleton& truth);
  void add_crops(const MadeScan& scan, const Extraction& seen, std::array<Crops, nn::kPartKinds>& made) const;

  PartKinds kinds_;
  std::array<ScanMaker, 3> makers_;  // few points, many, very many
  Rng rng_;
};

}  // namespace understudy::training
