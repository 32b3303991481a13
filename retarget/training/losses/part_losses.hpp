// The loss of parts seen from near: arms, legs, hands, head and feet.
#pragma once

#include "retarget/training/losses/skeleton_losses.hpp"

namespace understudy::training {

/// How far joints are off, [B, K], in leg lengths. Rows of `output` and `truth` as PartNet gives them.
inline torch::Tensor place_error(const torch::Tensor& output, const torch::Tensor& truth) {
  return (output.narrow(2, 6, 3) - truth.narrow(2, 6, 3)).square().sum(2).add(1e-8).sqrt();
}

/// output [B, K, 10], truth [B, K, 9].
inline torch::Tensor part_loss(const torch::Tensor& output, const torch::Tensor& truth) {
  const auto turn = (output.narrow(2, 0, 6) - truth.narrow(2, 0, 6)).abs().mean();
  const auto away = place_error(output, truth);
  return turn + 5 * away.mean() + 0.01 * spread_loss(away, output.select(2, 9));
}

}  // namespace understudy::training
