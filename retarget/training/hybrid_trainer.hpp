// Training of the hybrid engine: a recurrent network learns to correct the analytic solve of what the trained
// extractor saw.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>
#include <vector>

#include "retarget/nn/modules/hybrid_gru.hpp"
#include "retarget/nn/networks.hpp"
#include "retarget/training/hybrid_windows.hpp"
#include "retarget/training/motion_judge.hpp"

namespace understudy::training {

/// Windows after the joint filter and the analytic solve, for bodies other than the source's.
struct HybridBatch {
  nn::HybridInput input;
  torch::Tensor rest_b;  ///< [B, 22, 3] T-pose joints
  torch::Tensor truth;   ///< [B, T, 22, 3, 3] world rotations: the source's, as the target is to have them
};

HybridBatch make_hybrid_batch(const std::vector<HybridWindow>& windows, const std::vector<Joints>& bodies,
                              Rng& rng);

struct HybridTrainerOptions {
  nn::HybridGruOptions net;
  int batch = 24;                  ///< windows a step
  double learning_rate = 1e-3;     ///< falls to a hundredth over the training, along a cosine
  double position_weight = 6;      ///< metres, against radians
  double acceleration_weight = 6;  ///< metres/frame^2 at 30 frames/s
  uint64_t seed = 1;
  std::string device = "cpu";
};

/// Terms of one step, unweighted.
struct HybridStep {
  double rotation = 0, position = 0, acceleration = 0;
};

class HybridTrainer {
 public:
  /// `bodies`: T-pose joints of people that the motions are given to.
  HybridTrainer(const HybridTrainerOptions& options, std::vector<Joints> bodies);

  /// One step on windows drawn from `windows`: some mirrored, their errors made larger or smaller, some
  /// without rotations. progress 0..1 sets the learning rate.
  HybridStep step(const std::vector<HybridWindow>& windows, double progress);
  /// One step on this batch.
  HybridStep step(const HybridBatch& batch);

  /// Everything that the next step depends on, written beside the path, then renamed.
  void save_checkpoint(const std::string& path);
  /// Goes on from a checkpoint. Throws Error when the file is none of this trainer's.
  void load_checkpoint(const std::string& path);

  nn::HybridGru net{nullptr}, average{nullptr};  ///< as it learns; running mean, which is what is kept
  int64_t samples = 0;                           ///< frames seen
  double minutes = 0;                            ///< spent, kept by the caller

 private:
  void update_average();

  HybridTrainerOptions options_;
  std::vector<Joints> bodies_;
  Rng rng_;
  int64_t steps_ = 0;
  std::unique_ptr<torch::optim::AdamW> optimizer_;
};

/// Figures of the network and of the analytic solve alone, on the same windows.
struct HybridFigures {
  MotionFigures solve, hybrid;
};
HybridFigures judge_hybrid(nn::HybridGru& net, const HybridBatch& batch);

/// `understudy train hybrid`: makes the cache where it is missing or holds too few windows, then trains until
/// the options' limits, with checkpoints beside the weights and a learning curve. 0 when it came to the end,
/// 1 when it was cancelled. Throws Error.
int train_hybrid(const nn::TrainOptions& options);

}  // namespace understudy::training
