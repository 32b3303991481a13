// Losses of the deformation networks (paper 1, eq. 4, and direct supervision of weights and offsets).
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// Length of vectors along dimension `dim`; smooth at zero (a tenth of a millimetre) so that its gradient
/// exists there.
inline at::Tensor smooth_length(const at::Tensor& v, int64_t dim) {
  constexpr double kSoft = 1e-4;
  return (v.square().sum(dim) + kSoft * kSoft).sqrt() - kSoft;
}

/// Mean distance of posed points, metres (eq. 4 with the distance itself in place of its square: the metric
/// that is reported, and outliers do not rule). posed, truth [.., 3].
inline at::Tensor geometry_loss(const at::Tensor& posed, const at::Tensor& truth) {
  return smooth_length(posed - truth, -1).mean();
}

/// Mean change of the length between points 2i and 2i+1, metres. posed, truth [B, N, P, 3], N even.
inline at::Tensor edge_loss(const at::Tensor& posed, const at::Tensor& truth) {
  const auto edges = [](const at::Tensor& p) {
    return smooth_length(p.slice(1, 0, c10::nullopt, 2) - p.slice(1, 1, c10::nullopt, 2), -1);
  };
  return smooth_length((edges(posed) - edges(truth)).unsqueeze(-1), -1).mean();
}

/// Kullback-Leibler divergence of predicted from true skin weights, mean over points. Both [.., 22].
inline at::Tensor weight_loss(const at::Tensor& log_weights, const at::Tensor& truth) {
  const at::Tensor entropy = (truth * truth.clamp_min(1e-8).log()).sum(-1);
  return (entropy - (truth * log_weights).sum(-1)).mean();
}

/// Mean distance of offsets, metres. offsets, truth [B, N, 3, P].
inline at::Tensor offset_loss(const at::Tensor& offsets, const at::Tensor& truth) {
  return smooth_length(offsets - truth, 2).mean();
}

/// Mean distance to the same place on the mean body, metres, over the bodies that have one. [B, N, 3], has
/// [B].
inline at::Tensor canonical_loss(const at::Tensor& canonical, const at::Tensor& truth,
                                 const at::Tensor& has) {
  return (smooth_length(canonical - truth, -1).mean(1) * has).sum() / has.sum().clamp_min(1);
}

}  // namespace understudy::training
