// What the network learns from that reads lengths off 2D poses: simulated people, as detectors see them.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/pose2d/flat_people.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

struct ProportionBatch {
  torch::Tensor poses;       ///< [B, kProportionInputs]
  torch::Tensor log_length;  ///< [B, 14] of the pose's size
};

/// The split's people without clothes, as flat_people wants them.
std::vector<FlatPerson> flat_people_of(const TrainingData& data);

class ProportionData {
 public:
  explicit ProportionData(TrainingData data);
  /// Every pose is another person in another pose before another camera.
  ProportionBatch batch(int count, Rng& rng) const;

 private:
  FlatPerson random_person(Rng& rng) const;
  Pose random_posture(Rng& rng) const;

  TrainingData data_;
  std::vector<FlatPerson> people_;
};

}  // namespace understudy::training
