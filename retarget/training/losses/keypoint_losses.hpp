// What makes keypoints of voxels without labels (paper 3, section 4): equations 8 to 11. F frames, K
// keypoints. Those of affinities, equations 12 to 17, are in affinity_losses.
#pragma once

#include <torch/torch.h>

#include <algorithm>

namespace understudy::training {

/// L_vol, eq. 8: mean over frames of the mean over occupied cells of the squared distance to the nearest
/// keypoint. cells [F, P, 3] of which `counts` [F, P], 0 or 1, tells those that are there; places [F, K, 3].
inline torch::Tensor volume_fitting_loss(const torch::Tensor& cells, const torch::Tensor& counts,
                                         const torch::Tensor& places) {
  const auto squared = cells.square().sum(2, true) + places.square().sum(2).unsqueeze(1) -
                       2 * torch::matmul(cells, places.transpose(1, 2));  // [F, P, K]
  const auto nearest = std::get<0>(squared.min(2)).clamp_min(0);
  return ((nearest * counts).sum(1) / counts.sum(1).clamp_min(1)).mean();
}

/// L_recon, eq. 9: binary cross entropy of grids and the logits of what was decoded, mean over cells.
inline torch::Tensor reconstruction_loss(const torch::Tensor& logits, const torch::Tensor& voxels) {
  return torch::binary_cross_entropy_with_logits(logits, voxels);
}

/// L_sparse, eq. 10: mean over frames and keypoints of the heatmap's mean, [F, K, g, g, g].
inline torch::Tensor sparsity_loss(const torch::Tensor& heatmaps) {
  return heatmaps.abs().mean();
}

/// How much of its weight a loss has that is phased in while `done`, a share of the training, goes from
/// `begins` to `grown`: 0 before, 1 after.
inline double phased_in(double done, double begins, double grown) {
  return std::clamp((done - begins) / (grown - begins), 0.0, 1.0);
}

/// L_sep, eq. 11, of W windows: places [W, T, K, 3]; sigma_s is 1250. Two keypoints that go the same way are
/// too many.
inline torch::Tensor separation_loss(const torch::Tensor& places, double sigma_s = 1250) {
  const auto moved = places - places.mean(1, true);                              // s
  const auto apart = (moved.unsqueeze(3) - moved.unsqueeze(2)).square().sum(4);  // [W, T, K, K]
  const auto K = static_cast<double>(places.size(2));
  const auto all = (-sigma_s * apart).exp().mean(0).mean(0).sum();
  return (all - K) / (K * (K - 1));  // less k = k', which is 1 each
}

}  // namespace understudy::training
