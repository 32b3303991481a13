// Parameters of two networks of the same form.
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// to = share of from and the rest of to. Between the weights that training on other data began and ended
/// with lie some that are good on both (Wortsman et al. 2022, Robust fine-tuning of zero-shot models).
inline void mix_parameters(const torch::nn::Module& from, torch::nn::Module& to, double share) {
  const torch::NoGradGuard no_grad;
  const auto source = from.parameters();
  auto target = to.parameters();
  for (size_t i = 0; i < source.size(); ++i) target[i].mul_(1 - share).add_(source[i], share);
}

inline void copy_parameters(const torch::nn::Module& from, torch::nn::Module& to) {
  const torch::NoGradGuard no_grad;
  const auto source = from.parameters();
  auto target = to.parameters();
  for (size_t i = 0; i < source.size(); ++i) target[i].copy_(source[i]);
}

}  // namespace understudy::training
