#include "retarget/training/deformation_losses.hpp"

#include <torch/torch.h>

namespace understudy::training {
namespace {

/// Length of vectors along dimension `dim`; smooth at zero (a tenth of a millimetre) so that its gradient
/// exists there.
at::Tensor length(const at::Tensor& v, int64_t dim) {
  constexpr double kSoft = 1e-4;
  return (v.square().sum(dim) + kSoft * kSoft).sqrt() - kSoft;
}

}  // namespace

at::Tensor geometry_loss(const at::Tensor& posed, const at::Tensor& truth) {
  return length(posed - truth, -1).mean();
}

at::Tensor edge_loss(const at::Tensor& posed, const at::Tensor& truth) {
  const auto edges = [](const at::Tensor& p) {
    return length(p.slice(1, 0, c10::nullopt, 2) - p.slice(1, 1, c10::nullopt, 2), -1);
  };
  return length((edges(posed) - edges(truth)).unsqueeze(-1), -1).mean();
}

at::Tensor weight_loss(const at::Tensor& log_weights, const at::Tensor& truth) {
  const at::Tensor entropy = (truth * truth.clamp_min(1e-8).log()).sum(-1);
  return (entropy - (truth * log_weights).sum(-1)).mean();
}

at::Tensor offset_loss(const at::Tensor& offsets, const at::Tensor& truth) {
  return length(offsets - truth, 2).mean();
}

at::Tensor canonical_loss(const at::Tensor& canonical, const at::Tensor& truth, const at::Tensor& has) {
  return (length(canonical - truth, -1).mean(1) * has).sum() / has.sum().clamp_min(1);
}

}  // namespace understudy::training
