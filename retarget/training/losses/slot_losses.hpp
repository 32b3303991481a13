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

/// How far each keypoint k' takes each other k of `from` from where it is in `to`, [B, K', K]: nothing where
/// both carry a joint alike that is at k.
inline torch::Tensor missed_by(const nn::SlotOutput& from, const nn::SlotOutput& to) {
  const auto turn = torch::matmul(to.turns, from.turns.transpose(2, 3));                 // [B, K', 3, 3]
  const auto arm = from.places.unsqueeze(1) - from.places.unsqueeze(2);                  // [B, K', K, 3]
  const auto moved = torch::matmul(arm, turn.transpose(2, 3)) + to.places.unsqueeze(2);  // [B, K', K, 3]
  return ((moved - to.places.unsqueeze(1)).square().sum(3) + 1e-4).sqrt();
}

/// Mean over scans and keypoints k of how far others take it from where it is, the affine k' [K', K] more.
inline torch::Tensor joint_loss(const torch::Tensor& affinity, const torch::Tensor& missed) {
  return (missed * affinity).sum(1).mean();
}

/// Mean distance that keypoints go from frame to frame, [W, T, K, 3]: two that exchange their places go far.
inline torch::Tensor place_steps(const torch::Tensor& places) {
  const auto T = places.size(1);
  const auto steps = places.narrow(1, 1, T - 1) - places.narrow(1, 0, T - 1);
  return (steps.square().sum(3) + 1e-4).sqrt().mean();
}

/// Mean over keypoints of how many others are about as near as `reach`: places [B, K, 3].
inline torch::Tensor crowding_loss(const torch::Tensor& places, double reach = 0.1) {
  const auto squared = nn::squared_distance(places, places).clamp_min(0);
  return (-squared / (2 * reach * reach)).exp().sum(2).mean() - 1;
}

/// What keypoints hang on, from what it costs, [K', K]: columns sum to 1, the diagonal is 0.
inline torch::Tensor affinity_of_links(const torch::Tensor& costs, double sharp = 0.03) {
  const auto self = torch::eye(costs.size(0), torch::kBool).to(costs.device());
  return (-costs / sharp).masked_fill(self, -1e9).softmax(0);
}

}  // namespace understudy::training
