// What the network learns from that lifts 2D poses: simulated people who move, as detectors see them and the
// keypoint filter cleans them.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/pose2d/lift_truth.hpp"
#include "retarget/training/flat_shots.hpp"

namespace understudy::training {

/// B sequences of T frames.
struct LiftBatch {
  torch::Tensor frames;  ///< [B, T, kLiftInputs]
  torch::Tensor joints;  ///< [B, T, 22, 3] LiftTruth::joints, of LiftFrame::size
  torch::Tensor turns;   ///< [B, T, 22, 6] LiftTruth::turns
  torch::Tensor pitch;   ///< [B, T] sine of the camera's
};

/// Somebody before a camera for a while, cleaned.
struct LiftSequence {
  std::vector<FlatPose> poses;
  std::vector<LiftTruth> truth;
  BoneLengths lengths = BoneLengths::Ones();  ///< of the person, as they are believed to be
  float dt = 0, pitch = 0;                    ///< seconds between frames; sine of the camera's pitch
};

/// Sequences of T frames into row `row` of a batch that has room for them.
void put_sequence(const LiftSequence& sequence, int64_t row, LiftBatch& batch);
LiftBatch empty_lift_batch(int64_t sequences, int64_t frames);

/// What is wrong about what is known of somebody.
struct LiftErrors {
  DetectorErrors detector;
  float lengths = 0;  ///< standard deviation of the logarithms of the lengths that bones are believed to have
};
LiftSequence lift_sequence(const FlatShot& shot, float template_leg, const LiftErrors& errors, Rng& rng);

class LiftData {
 public:
  /// Throws Error when the data has no clip with 2 T frames in a row.
  LiftData(TrainingData data, int frames);
  /// Every sequence is another person in another motion before another camera, at 30 or 15 frames/s.
  LiftBatch batch(int count, Rng& rng) const;

 private:
  LiftSequence random_sequence(Rng& rng) const;

  FlatShots shots_;
};

}  // namespace understudy::training
