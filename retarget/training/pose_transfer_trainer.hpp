// Training of pose transfer without a skeleton, the peer of nn/modules/pose_transfer_net.hpp.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>

#include "retarget/nn/modules/pose_transfer_net.hpp"
#include "retarget/nn/networks.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// Normalised as the network sees them, [B, 1024, 3] each; size: metres of one unit of the target, [B].
struct PoseTransferBatch {
  torch::Tensor source, rest, posed, size;
};
PoseTransferBatch make_pose_transfer_batch(ScanMaker& maker, int count);

class PoseTransferTrainer {
 public:
  explicit PoseTransferTrainer(uint64_t seed);
  /// One step; progress 0..1 sets the learning rate. Mean squared distance of the points.
  double step(const PoseTransferBatch& batch, double progress);
  /// Mean distance of the points, metres.
  double judge(const PoseTransferBatch& batch);
  /// Everything that the next step depends on but the data, written beside the path, then renamed.
  void save_checkpoint(const std::string& path);
  /// Goes on from a checkpoint. Throws Error when the file is none of this trainer's.
  void load_checkpoint(const std::string& path);

  nn::PoseTransferNet net;
  int64_t samples = 0;
  double minutes = 0;  ///< spent, kept by the caller

 private:
  std::unique_ptr<torch::optim::Adam> optimizer_;
};

/// `understudy train pose-transfer`: trains until the options' limits, with checkpoints beside the weights
/// and a learning curve. 0 when it came to the end, 1 when it was cancelled. Throws Error.
int train_pose_transfer(const nn::TrainOptions& options);

}  // namespace understudy::training
