// What the network that lifts 2D poses minimises, and how well it lifts people and motions held back.
#pragma once

#include <torch/torch.h>

#include "retarget/nn/modules/lifter_net.hpp"
#include "retarget/training/lift_data.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

/// Distances of joints, of their ways from frame to frame, and of bones' lengths (of the person's size); the
/// likelihood of the distances; rotations and the camera's pitch.
LossSum lift_loss(nn::LifterNet& net, const LiftBatch& batch, const torch::Device& device);

/// People of the split before cameras: clean, and with points 15 mm off along each axis.
class LiftFigures {
 public:
  /// Throws Error when the data has no clip with as many frames in a row.
  LiftFigures(TrainingData data, int cases, int frames);
  /// mm of all 22 joints, middle of the hips on that of the truth, each frame in its best scale; degrees that
  /// the camera's pitch is off that the whole sequence tells; clean and noisy.
  Figures of(nn::LifterNet& net, const torch::Device& device) const;

 private:
  struct Suite {
    const char* name;
    LiftBatch batch;
    std::vector<std::vector<LiftTruth>> truth;  // [cases, frames]
  };
  std::vector<Suite> suites_;
};

}  // namespace understudy::training
