// Bodies of one kind that move, made as they are asked for: what the networks of paper 3 learn from.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/rig/rig.hpp"
#include "retarget/training/clip_poses.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// Creatures are made by code, people come from the data folder. Every body of a kind has the same bones. Of
/// one thread.
class KindData {
 public:
  /// kind: one of kBodyKinds. Throws Error for another, and naming what of the folder cannot be
  /// read; the folder does not matter to creatures.
  KindData(const std::string& kind, const std::string& folder, Split split);

  /// A body and what it performs, `frames` frames at `fps`, from anywhere in a motion. The body turns to any
  /// side and stands at the origin in its first frame.
  RiggedMotion draw(int frames, double fps, Rng& rng) const;
  /// Seconds of the longest motion that can be drawn; creatures go on for ever.
  double longest() const;

 private:
  RiggedMotion draw_creature(int frames, double fps, Rng& rng) const;
  RiggedMotion draw_person(int frames, double fps, Rng& rng) const;

  const Rig& creature(int number) const;

  int creature_ = -1;  // a CreatureKind; -1: people
  uint64_t first_seed_ = 0;
  mutable std::vector<std::optional<Rig>> rigs_;  // creatures, each made when it is first asked for
  std::optional<TrainingData> people_;
  std::vector<ClipRun> runs_;
  std::optional<ClipPoses> poses_;
};

/// So many points of a rig's surface at rest, evenly, with their skin: what is posed quickly.
struct SkinnedPoints {
  Points rest{0, 3};
  SkinWeights skin;
};
SkinnedPoints points_on(const Rig& rig, int count, Rng& rng);

}  // namespace understudy::training
