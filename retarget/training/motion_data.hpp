// Motion sequences for the training of motion transfer, made on the fly: no motion is ever seen on two
// bodies.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/training/clip_poses.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// B sequences of T frames. The first `crossed` of them go to another body, whose own motions are `real`; for
/// the others A and B are one body.
struct MotionBatch {
  torch::Tensor joints;     ///< [B, T, 22, 3] A's joints as an extractor would see them: with errors, metres
  torch::Tensor leg;        ///< [B, T] A's leg length, mean over the frames so far, metres
  torch::Tensor dt;         ///< [B, T] seconds
  torch::Tensor clean;      ///< [B, T, 22, 3] A's joints without errors, the pelvis at the origin
  torch::Tensor rotations;  ///< [B, T, 22, 3, 3] A's local rotations
  torch::Tensor rest_a;     ///< [B, 22, 3] T-pose joints, metres
  torch::Tensor rest_b;     ///< [B, 22, 3]
  torch::Tensor seen_b;     ///< [B, 22, 3] rest_b as an extractor would see it
  /// [crossed, T, 22, 3] other, captured motions of rest_b's bodies, the pelvis at the origin
  torch::Tensor real;
  int64_t crossed = 0;
};

struct MotionBatchOptions {
  int size = 32;
  int frames = 30;       ///< the paper's context
  float noise = 0.035f;  ///< greatest mean length of the joints' errors, metres
};

/// Cuts clips into stretches of two seconds and gives each stretch one body, for good.
class MotionData {
 public:
  explicit MotionData(const TrainingData& data);
  MotionBatch batch(const MotionBatchOptions& options, Rng& rng) const;
  size_t stretches() const { return stretches_.size(); }

 private:
  struct Stretch : ClipRun {
    int body = 0;
  };
  struct Sequence {
    std::vector<Rotations> local;
    std::vector<Joints> joints;  // the pelvis at the origin
  };
  const Stretch& random_stretch(Rng& rng) const;
  const Stretch& stretch_of_another(const Stretch& stretch, Rng& rng) const;
  /// `frames` frames, `step` frames of the clip apart.
  Sequence sequence(const Stretch& stretch, int frames, float step, Rng& rng) const;
  void fill(MotionBatch& batch, int64_t row, const MotionBatchOptions& options, Rng& rng) const;

  ClipPoses clips_;
  std::vector<Joints> bodies_;  // T-pose joints
  std::vector<Stretch> stretches_;
  std::vector<std::vector<int>> of_clip_;  // stretches of each clip that has one
};

/// Errors of an extractor, added to joints: part of them stays, part drifts, part changes with each frame;
/// now and then a limb is lost for a few frames. `size` is their mean length in metres.
void add_joint_errors(std::vector<Joints>& joints, float size, float dt, Rng& rng);

/// Of each frame the mean leg length over the frames so far, metres.
std::vector<float> mean_leg_lengths(const std::vector<Joints>& joints);

}  // namespace understudy::training
