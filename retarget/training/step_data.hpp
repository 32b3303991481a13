// Steps for the network of paper 2: none is ever seen twice the same.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/motion_space/step_clips.hpp"
#include "retarget/training/clip_poses.hpp"

namespace understudy::training {

/// B movements.
struct StepBatch {
  torch::Tensor movements;  ///< [B, kStepNumbers]
  torch::Tensor rest;       ///< [B, 22, 3] T-pose joints of who performs them
};

class StepData {
 public:
  /// `mean_leg_m`: the legs that the clips' paths are for.
  StepData(const std::vector<StepClip>& clips, float mean_leg_m);

  /// Steps, half of them weighed by clip, so that short, rare clips count: some in a mirror, some begun at
  /// another phase of the cycle, quicker and slower ones, some with the arms of another step at the same
  /// phase.
  StepBatch batch(int count, Rng& rng) const;
  double mean_seconds() const;

 private:
  struct Captured {
    int clip = 0;
    float first = 0, frames = 0;  // where it begins, how long it is
    bool left_first = false;
    int run_first = 0, run_last = 0;  // good frames around it
  };
  using Knots = std::vector<Pose>;
  const Captured& random_step(Rng& rng) const;
  /// From that share of the cycle later on, as far as the clip is good.
  Knots knots_of(const Captured& step, float phase, bool mirror) const;
  void put(const Knots& knots, float seconds, int clip, int64_t row, StepBatch& batch) const;

  ClipPoses poses_;
  float mean_leg_m_;
  std::vector<Joints> rest_;               // of each clip
  std::vector<Captured> steps_;            // clip by clip
  std::vector<std::vector<int>> of_clip_;  // their numbers
};

}  // namespace understudy::training
