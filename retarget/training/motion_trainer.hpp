// Training of motion transfer (paper 1, eq. 2): unpaired, in a cycle from A to B and back.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>

#include "retarget/networks/networks.hpp"
#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/training/motion_data.hpp"
#include "retarget/training/motion_discriminator.hpp"

namespace understudy::training {

struct MotionTrainerOptions {
  nn::MotionGruOptions net;
  MotionBatchOptions batch;
  double learning_rate = 1e-3;  ///< falls to a hundredth over the training, along a cosine
  double telling_rate = 2e-4;   ///< of the discriminator
  double adversarial_weight =
      1e-4;                        ///< joints are in metres here; the paper names no unit for its weight of 1
  double rotation_weight = 0.01;   ///< lambda_rot
  double smoothness_weight = 0.1;  ///< lambda_smooth
  uint64_t seed = 1;
  std::string device = "cpu";
};

/// Terms of one step, unweighted.
struct MotionStep {
  double cycle = 0, rotation = 0, smoothness = 0, adversarial = 0, accuracy = 0;
};

class MotionTrainer {
 public:
  explicit MotionTrainer(const MotionTrainerOptions& options);

  /// One step on a fresh batch of `data`; progress 0..1 sets the learning rate.
  MotionStep step(const MotionData& data, double progress);
  /// One step on this batch.
  MotionStep step(const MotionBatch& batch);

  /// Everything that the next step depends on, written beside the path, then renamed.
  void save_checkpoint(const std::string& path);
  /// Goes on from a checkpoint. Throws Error when the file is none of this trainer's.
  void load_checkpoint(const std::string& path);

  const nn::MotionGruOptions& form() const { return options_.net; }

  nn::MotionGru net{nullptr};
  MotionDiscriminator discriminator{nullptr};
  int64_t samples = 0;  ///< sequences seen
  double minutes = 0;   ///< spent, kept by the caller

 private:
  MotionStep learn(const MotionBatch& batch);
  double tell_apart(const MotionBatch& batch, const torch::Tensor& made);

  MotionTrainerOptions options_;
  Rng rng_;
  std::unique_ptr<torch::optim::Adam> optimizer_, telling_optimizer_;
};

/// `understudy train motion`: trains until the options' limits, with checkpoints beside the weights
/// (.checkpoint) and a learning curve. 0 when it came to the end, 1 when it was cancelled. Throws Error.
int train_motion(const nn::TrainOptions& options);

}  // namespace understudy::training
