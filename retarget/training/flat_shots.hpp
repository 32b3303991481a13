// People of the data who move before cameras, as 2D poses are learned from.
#pragma once

#include <vector>

#include "retarget/pose2d/flat_people.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// Who moves how.
struct FlatShot {
  FlatPerson person;
  const Clip* clip = nullptr;
  int first = 0, step = 1, frames = 1;  ///< of the clip
  const Clip* upper = nullptr;          ///< whose trunk, arms and head it is; none: the clip's own
  int upper_first = 0;
  bool mirrored = false;
  float speed = 1;                          ///< of the clip's own
  Rotations turned = identity_rotations();  ///< joints are bent so much further, all the time
};

/// A shot before a camera that nobody comes too near.
struct ShotSight {
  std::vector<Pose> poses;  ///< on the person's own legs
  Pinhole camera;
  float dt = 0;  ///< seconds between frames
};
/// template_leg: of the body that the clips were made for, metres.
ShotSight seen_shot(const FlatShot& shot, float template_leg, Rng& rng);

class FlatShots {
 public:
  /// Throws Error when the data has no clip with `frames` in a row.
  FlatShots(TrainingData data, int frames);
  /// Another person, some with bones scaled apart, in another motion, some in two, at 30 or 15 frames/s.
  FlatShot random(Rng& rng) const;
  /// The people and clips as they are.
  FlatShot plain(Rng& rng) const;
  int frames() const { return frames_; }
  float template_leg() const { return data_.template_leg; }

 private:
  const FlatPerson& anybody(Rng& rng) const;
  const ClipRun& any_run(Rng& rng) const;
  const Clip& clip_of(const ClipRun& run) const { return data_.clips[static_cast<size_t>(run.clip)]; }

  TrainingData data_;
  int frames_;
  std::vector<FlatPerson> people_;
  std::vector<ClipRun> runs_;
  int64_t all_ = 0;  // frames in the runs
};

}  // namespace understudy::training
