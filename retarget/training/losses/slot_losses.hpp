// The losses of slots, which need no label: what moves together is carried together.
#pragma once

#include <torch/torch.h>

#include "retarget/nn/modules/skeleton_extractor.hpp"
#include "retarget/nn/modules/slot_net.hpp"

namespace understudy::training {

/// Mean over points [B, N, 3] of the distance to the nearest of `others` [B, M, 3], smooth at zero.
inline torch::Tensor nearest_distance(const torch::Tensor& points, const torch::Tensor& others) {
  const auto squared = std::get<0>(nn::squared_distance(points, others).min(2)).clamp_min(0);
  return (squared + 1e-4).sqrt().mean();
}

/// The points of scans `from`, each carried by the slots that share it to where they are in `to`,
/// [B, N, 3]: sum_k w_ik (R_k,to R_k,from^T (x_i - mu_k,from) + mu_k,to).
inline torch::Tensor carried(const torch::Tensor& points, const nn::SlotOutput& from,
                             const nn::SlotOutput& to) {
  const auto turn = torch::matmul(to.turns, from.turns.transpose(2, 3));  // [B, K, 3, 3]
  const auto shift = to.places - torch::matmul(turn, from.places.unsqueeze(3)).squeeze(3);
  const auto blend = torch::matmul(from.shares, turn.flatten(2));  // [B, N, 9]
  const auto moved = torch::matmul(blend.view({blend.size(0), blend.size(1), 3, 3}), points.unsqueeze(3));
  return moved.squeeze(3) + torch::matmul(from.shares, shift);
}

/// Where a keypoint hangs on another one is a joint: both carry it alike. Mean over scans and keypoints k of
/// the distance between where k is in `to` and where k' takes the k of `from`, the affine k' [K, K] more.
inline torch::Tensor joint_loss(const torch::Tensor& affinity, const nn::SlotOutput& from,
                                const nn::SlotOutput& to) {
  const auto turn = torch::matmul(to.turns, from.turns.transpose(2, 3));                 // [B, K', 3, 3]
  const auto arm = from.places.unsqueeze(1) - from.places.unsqueeze(2);                  // [B, K', K, 3]
  const auto moved = torch::matmul(arm, turn.transpose(2, 3)) + to.places.unsqueeze(2);  // [B, K', K, 3]
  const auto apart = ((moved - to.places.unsqueeze(1)).square().sum(3) + 1e-4).sqrt();   // [B, K', K]
  return (apart * affinity.transpose(0, 1)).sum(1).mean();
}

}  // namespace understudy::training
