// Losses of steps (paper 2, section 3.3), and their weights by the norms of their gradients.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/body/body.hpp"
#include "retarget/motion_space/step_form.hpp"

namespace understudy::training {

/// Distance of the vertices of a body in two movements (paper 2, eq. 2), by linear blend skinning: exact for
/// all vertices, though none is made. A vertex is linear in the joints' transforms, v = sum_j w_j T_j x, so
/// the mean of |v - v^|^2 is a quadratic form of T - T^ whose matrix [88, 88] depends on the body alone.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const ShapedBody& body);
  /// Mean of |v - v^|^2 over the vertices, metres^2: [B, T] for movements [B, kStepNumbers] whose path is in
  /// this body's legs.
  torch::Tensor squared(const torch::Tensor& movements, const torch::Tensor& truth) const;
  /// World transforms of the joints from the T-pose, [B, T, 3, 88].
  torch::Tensor transforms(const torch::Tensor& movements) const;

 private:
  torch::Tensor rest_;  // [1, 22, 3], the pelvis at the origin
  torch::Tensor form_;  // [88, 88]
  double leg_m_;
};

/// Differences of a part of movements, squared, summed over a knot and averaged over knots and batch.
torch::Tensor part_loss(const torch::Tensor& movements, const torch::Tensor& truth, int64_t first,
                        int64_t count);

/// Divergence of N(mean, exp(log_variance)) from N(0, 1), summed over the code's numbers and averaged over
/// the batch, nats.
torch::Tensor divergence(const torch::Tensor& mean, const torch::Tensor& log_variance);

/// Weights of losses by the norms of their gradients, so that they fall in like proportions (GradNorm, Chen
/// et al. 2018). The first weight stays 1.
class LossBalance {
 public:
  explicit LossBalance(int64_t losses);
  /// `shared`: what the losses are made from, before the ways part.
  void update(const std::vector<torch::Tensor>& losses, const torch::Tensor& shared);
  double weight(int64_t loss) const { return std::exp(log_weights_[loss].item<double>()); }
  /// [2, losses]: what a checkpoint keeps.
  torch::Tensor state() const { return torch::stack({log_weights_, first_}); }
  void set_state(const torch::Tensor& state);

 private:
  torch::Tensor log_weights_, first_;  // first_: the losses when it began; 0 before
};

}  // namespace understudy::training
