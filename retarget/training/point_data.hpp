// What the filter of 2D points learns from: simulated people who move, and how detectors see them.
#pragma once

#include <torch/torch.h>

#include "retarget/nn/modules/point_gains_net.hpp"
#include "retarget/training/flat_shots.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

/// B shots of T frames, BODY_25's points.
struct PointBatch {
  nn::SeenPoints seen;
  torch::Tensor truth;  ///< [B, T, 25, 2] pixels
};

class PointData {
 public:
  /// Throws Error when the data has no clip with `frames` in a row.
  PointData(TrainingData data, int frames) : shots_(std::move(data), frames) {}
  /// Shots of any rate, points up to 25 mm off, some missing.
  PointBatch batch(int count, Rng& rng) const;
  /// People and clips as they are, seen with those errors.
  PointBatch plain(int count, const DetectorErrors& errors, Rng& rng) const;

 private:
  void put(const FlatShot& shot, const DetectorErrors& errors, int64_t row, PointBatch& batch,
           Rng& rng) const;

  FlatShots shots_;
};

/// Means over shots of keypoint_similarity and of jitter, both of the first 15 points: [B] each.
struct PointFigures {
  torch::Tensor oks, jitter;
};
PointFigures point_figures(const torch::Tensor& shown, const torch::Tensor& truth);

}  // namespace understudy::training
