// What the network learns from that lifts 2D poses: simulated people who move, as detectors see them and the
// keypoint filter cleans them.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/lift_truth.hpp"
#include "retarget/training/training_data.hpp"

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
  float dt = 0, pitch = 0;  ///< seconds between frames; sine of the camera's pitch
};

/// Sequences of T frames into row `row` of a batch that has room for them.
void put_sequence(const LiftSequence& sequence, int64_t row, LiftBatch& batch);
LiftBatch empty_lift_batch(int64_t sequences, int64_t frames);

/// How somebody is seen.
struct LiftShot {
  FlatPerson person;
  const Clip* clip = nullptr;
  int first = 0, step = 1, frames = 1;  ///< of the clip
  bool mirrored = false;
  float speed = 1;                          ///< of the clip's own
  Rotations turned = identity_rotations();  ///< joints are bent so much further, all the time
};
/// Everything with `errors` of a detector; points in `never` are not seen at all.
LiftSequence lift_sequence(const LiftShot& shot, float template_leg, const DetectorErrors& errors, Rng& rng);

class LiftData {
 public:
  /// Throws Error when the data has no clip with 2 T frames in a row.
  LiftData(TrainingData data, int frames);
  /// Every sequence is another person in another motion before another camera, at 30 or 15 frames/s.
  LiftBatch batch(int count, Rng& rng) const;

 private:
  LiftSequence random_sequence(Rng& rng) const;

  TrainingData data_;
  int frames_;
  std::vector<FlatPerson> people_;
  std::vector<ClipRun> runs_;
  int64_t all_ = 0;  // frames in the runs
};

}  // namespace understudy::training
