// Windows of motion with holes, for the network of the motion space: no window is ever seen twice.
#pragma once

#include <torch/torch.h>

#include <optional>
#include <vector>

#include "retarget/nn/modules/inbetween_net.hpp"
#include "retarget/training/clip_poses.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// B windows of T frames of one body: the template's.
struct InbetweenBatch {
  nn::InbetweenInput input;  ///< the curve through what is known
  torch::Tensor rotations;   ///< [B, T, 22, 3, 3] the truth
  torch::Tensor root;        ///< [B, T, 3]
};

class InbetweenData {
 public:
  explicit InbetweenData(const TrainingData& data);

  /// As many windows as have about `frames` frames together, all equally long (8 to 110 frames). Most have
  /// one gap; others every n-th frame, the past only, or some joints; some of what is known has the errors of
  /// an extractor.
  InbetweenBatch batch(int frames, Rng& rng) const;

  /// One gap of `gap` frames with `ends` known ones on each side, at every `every`-th frame of all clips.
  /// `travelling`: only of clips whose pelvis goes at more than 0.6 m/s half of the time. None where no clip
  /// is long enough.
  std::optional<InbetweenBatch> gaps(int gap, int ends, int every, bool travelling) const;

 private:
  struct Window {
    Motion truth, shown;  // as it is, and with errors where it is known
    std::vector<KnownParts> known;
  };
  const ClipRun& random_run(int frames, Rng& rng) const;
  Motion random_motion(int frames, Rng& rng) const;
  InbetweenBatch batch_of(const std::vector<Window>& windows) const;

  ClipPoses clips_;
  Joints rest_;
  std::vector<ClipRun> runs_;
  std::vector<std::vector<int>> of_clip_;
  std::vector<bool> travels_;
};

}  // namespace understudy::training
