// Losses of the deformation networks (paper 1, eq. 4, and direct supervision of weights and offsets).
#pragma once

#include <ATen/core/Tensor.h>

namespace understudy::training {

/// Mean distance of posed points, metres (eq. 4 with the distance itself in place of its square: the metric
/// that is reported, and outliers do not rule). posed, truth [.., 3].
at::Tensor geometry_loss(const at::Tensor& posed, const at::Tensor& truth);

/// Mean change of the length between points 2i and 2i+1, metres. posed, truth [B, N, P, 3], N even.
at::Tensor edge_loss(const at::Tensor& posed, const at::Tensor& truth);

/// Kullback-Leibler divergence of predicted from true skin weights, mean over points. Both [.., 22].
at::Tensor weight_loss(const at::Tensor& log_weights, const at::Tensor& truth);

/// Mean distance of offsets, metres. offsets, truth [B, N, 3, P].
at::Tensor offset_loss(const at::Tensor& offsets, const at::Tensor& truth);

/// Mean distance to the same place on the mean body, metres, over the bodies that have one. [B, N, 3], has
/// [B].
at::Tensor canonical_loss(const at::Tensor& canonical, const at::Tensor& truth, const at::Tensor& has);

}  // namespace understudy::training
