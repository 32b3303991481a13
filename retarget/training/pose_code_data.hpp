// What the networks of Zheng et al. (2021) learn from: people, each with motions of their own, in pictures.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/pose2d/flat_people.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// Pairs (x of A, y of B) and the people of both.
struct PoseCodeBatch {
  torch::Tensor poses;   ///< [N, 15, 3] x as seen
  torch::Tensor whole;   ///< [N, 15, 2] x without what is missing or off
  torch::Tensor own;     ///< [N, 15, 2] y
  torch::Tensor people;  ///< [N, 14] PersonCodeInput of B
  torch::Tensor person;  ///< [N] number of B
  int64_t within = 0;    ///< the first so many have A = B
};

/// As in the paper no motion is ever on two bodies: the pairs that a supervised training would need do not
/// exist.
class PoseCodeData {
 public:
  static constexpr int kPeople = 64;  ///< half with bones scaled apart
  /// Throws Error when the data has no person or no clip.
  PoseCodeData(TrainingData data, uint64_t seed);
  PoseCodeBatch batch(int count, Rng& rng) const;

 private:
  struct Person {
    FlatPerson body;
    std::vector<ClipRun> runs;  ///< stretches of motion, nobody else's
  };
  FlatSight any_sight(const Person& person, Rng& rng) const;

  TrainingData data_;
  std::vector<Person> people_;
};

/// On people and motions that nothing was learned from, bones scaled apart (the performer's in every other
/// case), true lengths told. In the paper's units (table 2): lengths, the mean squared difference of bones'
/// lengths; angles, that of their directions, rad^2; joints, the mean distance of points, boxes' centres
/// aligned; oks. And violation, near_kept (% of the source's touches), angles_rad against the source.
class PoseCodeFigures {
 public:
  PoseCodeFigures(const TrainingData& data, int cases);
  /// What is made of poses [N, 15, 3] for people [N, 14]: [N, 15, 2].
  using Transfer = std::function<torch::Tensor(const torch::Tensor& poses, const torch::Tensor& people)>;
  Figures of(const Transfer& transfer) const;

 private:
  struct Case {
    FlatPose source, truth;
    float source_stature = 1, stature = 1;  // pixels
  };
  std::vector<Case> cases_;
  torch::Tensor poses_, people_;
};

}  // namespace understudy::training
