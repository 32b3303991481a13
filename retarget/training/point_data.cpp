#include "retarget/training/point_data.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "retarget/keypoints/point_deviations.hpp"
#include "retarget/keypoints/proportions.hpp"
#include "retarget/keypoints/track_noise.hpp"

namespace understudy::training {
namespace {

constexpr float kClearShots = 0.25f, kMostPointJitter = 0.025f;  // share; metres
constexpr float kGappyShots = 0.5f, kMostPointsMissing = 0.1f;   // shares
constexpr float kFastestPoints = 1.5f;  // times as fast a shot may be: films of up to 60 frames/s

PointBatch empty_point_batch(int64_t count, int64_t frames) {
  PointBatch batch;
  batch.seen = {torch::zeros({count, frames, kBodyPoints, 2}), torch::zeros({count, frames, kBodyPoints}),
                torch::ones({count, frames, kBodyPoints}), torch::ones({count, frames}),
                torch::ones({count})};
  batch.truth = torch::zeros({count, frames, kBodyPoints, 2});
  return batch;
}

float* row_of(const torch::Tensor& tensor, int64_t row, int64_t frame) {
  return tensor.select(0, row).select(0, frame).data_ptr<float>();
}

void put_places(const FlatPose& pose, float* places) {
  using Places = Eigen::Matrix<float, kBodyPoints, 2, Eigen::RowMajor>;
  Eigen::Map<Places>{places} = pose.body.leftCols<2>();
}

}  // namespace

void PointData::put(const FlatShot& shot, const DetectorErrors& errors, int64_t row, PointBatch& batch,
                    Rng& rng) const {
  const ShotSight sight = seen_shot(shot, shots_.template_leg(), rng);
  TrackNoise noise;
  batch.seen.dt[row] = sight.dt;
  DetectorErrors first = errors;
  first.missing = 0;
  for (int t = 0; t < shot.frames; ++t) {
    const FlatSight truth = seen_flat(shot.person, sight.poses[static_cast<size_t>(t)], sight.camera);
    const FlatPose seen = detected(truth, t == 0 ? first : errors, rng);
    noise.push(seen, sight.dt);
    put_places(truth.pose, row_of(batch.truth, row, t));
    put_places(seen, row_of(batch.seen.places, row, t));
    float *is_seen = row_of(batch.seen.is_seen, row, t), *sigma = row_of(batch.seen.sigma, row, t);
    for (int p = 0; p < kBodyPoints; ++p) is_seen[p] = seen.has(p) ? 1.0f : 0.0f, sigma[p] = noise.sigma();
    *row_of(batch.seen.size, row, t) = noise.size();
  }
}

PointBatch PointData::batch(int count, Rng& rng) const {
  PointBatch batch = empty_point_batch(count, shots_.frames());
  for (int row = 0; row < count; ++row) {
    FlatShot shot = shots_.random(rng);
    shot.speed *= rng.uniform(1, kFastestPoints);
    DetectorErrors errors;
    if (!rng.chance(kClearShots)) errors.jitter_m = rng.uniform(0, kMostPointJitter);
    if (rng.chance(kGappyShots)) errors.missing = rng.uniform(0, kMostPointsMissing);
    put(shot, errors, row, batch, rng);
  }
  return batch;
}

PointBatch PointData::plain(int count, const DetectorErrors& errors, Rng& rng) const {
  PointBatch batch = empty_point_batch(count, shots_.frames());
  for (int row = 0; row < count; ++row) put(shots_.plain(rng), errors, row, batch, rng);
  return batch;
}

PointFigures point_figures(const torch::Tensor& all_shown, const torch::Tensor& all_truth) {
  const auto shown = all_shown.slice(2, 0, kPaperPoints), truth = all_truth.slice(2, 0, kPaperPoints);
  const auto length = [](const torch::Tensor& ways) { return ways.square().sum(-1).add(1e-8).sqrt(); };
  const auto second = [&](const torch::Tensor& places) {
    const int64_t T = places.size(1);
    return length(places.slice(1, 2) - 2 * places.slice(1, 1, T - 1) + places.slice(1, 0, T - 2))
        .mean({1, 2});
  };
  std::vector<float> kappa;
  for (int p = 0; p < kPaperPoints; ++p)
    kappa.push_back(static_cast<float>(2 * kPointDeviation[static_cast<size_t>(p)]));
  const auto box = std::get<0>(truth.max(2)) - std::get<0>(truth.min(2));
  const auto area = kAreaOfBox * box.select(-1, 0) * box.select(-1, 1);
  const auto spread = 2 * area.unsqueeze(-1) * torch::tensor(kappa).square().to(truth.device());
  return {100 * torch::exp(-(shown - truth).square().sum(-1) / spread).mean({1, 2}),
          second(shown) / second(truth)};
}

}  // namespace understudy::training
