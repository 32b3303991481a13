// Losses of motion words (paper 4, section 3.4).
#pragma once

#include <torch/torch.h>

#include "retarget/style/motion_words.hpp"

namespace understudy::training {

/// Eq. 5, 6: what comes back there and back again; words [B, T, N].
inline torch::Tensor word_cycle_loss(const torch::Tensor& again, const torch::Tensor& words) {
  return (again - words).abs().mean();
}

/// Eq. 7, 8: mean change from frame to frame of made words. It favours stillness.
inline torch::Tensor word_coherence_loss(const torch::Tensor& made) {
  return (made.slice(1, 1) - made.slice(1, 0, made.size(1) - 1)).abs().mean();
}

/// In its place, beyond the paper: the change of made words against that of those that they were made of.
inline torch::Tensor word_velocity_loss(const torch::Tensor& made, const torch::Tensor& words) {
  return word_coherence_loss(made - words);
}

/// Eq. 9, 10: what two neighbouring made words say of the frames that are in both.
inline torch::Tensor word_transition_loss(const torch::Tensor& made, const torch::Tensor& next) {
  return (made.slice(1, kWordStride) - next.slice(1, 0, kWordFrames - kWordStride)).abs().mean();
}

}  // namespace understudy::training
