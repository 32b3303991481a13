#include "retarget/training/losses/step_losses.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/modules/tensor_of.hpp"

namespace understudy::training {
namespace {

constexpr int64_t kAffine = 4 * kJointCount;
constexpr double kRestoring = 0.5;  // GradNorm's alpha
constexpr double kFollow = 0.1;     // of an update
constexpr double kMostWeight = 7;   // logarithm, both ways

RowMatrix quadratic_form(const ShapedBody& body) {
  const auto count = body.vertices.rows();
  RowMatrix parts(count, kAffine);  // of each vertex w_j [x, 1]
  for (int j = 0; j < kJointCount; ++j) {
    parts.middleCols(4 * j, 3) = body.vertices.array().colwise() * body.weights.col(j).array();
    parts.col(4 * j + 3) = body.weights.col(j);
  }
  const Eigen::MatrixXd wide = parts.cast<double>();
  return (wide.transpose() * wide / static_cast<double>(count)).cast<float>();
}

}  // namespace

SurfaceDistance::SurfaceDistance(const ShapedBody& body) : leg_m_(leg_length(body.joints)) {
  ShapedBody centred = body;
  const Eigen::RowVector3f pelvis = body.joints.row(Pelvis);
  centred.vertices.rowwise() -= pelvis;
  centred.joints.rowwise() -= pelvis;
  rest_ = nn::tensor_of(centred.joints).unsqueeze(0);
  form_ = nn::tensor_of(quadratic_form(centred));
}

torch::Tensor SurfaceDistance::transforms(const torch::Tensor& movements) const {
  const int64_t batch = movements.size(0);
  const auto none = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, movements.options());
  const auto turns = movements.slice(1, 0, kStepTurns).view({batch, kKnots, kJointCount, 6}) + none;
  const auto root =
      leg_m_ * movements.slice(1, kStepTurns, kStepTurns + kStepPath).view({batch, kKnots, 1, 3});
  const auto rest = rest_.to(movements.dtype());
  const auto posed =
      nn::forward_kinematics(rest.expand({batch, kJointCount, 3}), nn::rotations_from_6d(turns));
  const auto from_rest = (posed.global * rest.view({1, 1, kJointCount, 1, 3})).sum(-1);
  const auto way = posed.joints + root - from_rest;                       // [B, T, 22, 3]
  const auto affine = torch::cat({posed.global, way.unsqueeze(-1)}, -1);  // [B, T, 22, 3, 4]
  return affine.transpose(2, 3).reshape({batch, kKnots, 3, kAffine});
}

torch::Tensor SurfaceDistance::squared(const torch::Tensor& movements, const torch::Tensor& truth) const {
  const auto apart = transforms(movements) - transforms(truth);  // [B, T, 3, 88]
  return (torch::matmul(apart, form_.to(apart.dtype())) * apart).sum({2, 3}).clamp_min(0);
}

torch::Tensor part_loss(const torch::Tensor& movements, const torch::Tensor& truth, int64_t first,
                        int64_t count) {
  return (movements - truth).slice(1, first, first + count).square().sum(1).mean() / kKnots;
}

torch::Tensor divergence(const torch::Tensor& mean, const torch::Tensor& log_variance) {
  return 0.5 * (mean.square() + log_variance.exp() - 1 - log_variance).sum(1).mean();
}

LossBalance::LossBalance(int64_t losses)
    : log_weights_(torch::zeros({losses}, torch::kFloat64)),
      first_(torch::zeros({losses}, torch::kFloat64)) {}

void LossBalance::update(const std::vector<torch::Tensor>& losses, const torch::Tensor& shared) {
  const auto count = static_cast<int64_t>(losses.size());
  US_CHECK(count == log_weights_.size(0), "weights for ", log_weights_.size(0), " losses, not ", count);
  auto norms = torch::empty({count}, torch::kFloat64), now = torch::empty({count}, torch::kFloat64);
  for (int64_t i = 0; i < count; ++i) {
    const auto& loss = losses[static_cast<size_t>(i)];
    norms[i] = torch::autograd::grad({loss}, {shared}, {}, true)[0].norm().to(torch::kFloat64);
    now[i] = loss.detach().to(torch::kFloat64);
  }
  if (!torch::isfinite(norms).all().item<bool>() || (norms <= 0).any().item<bool>()) return;
  if ((first_ <= 0).all().item<bool>()) {
    first_ = now.clamp_min(1e-12);
    log_weights_ = -norms.log();  // at once: the first guess would take long to correct
  } else {
    const auto rate = (now / first_).clamp_min(1e-12).log();  // how far it has fallen
    const auto wanted = kRestoring * (rate - rate.mean()) - norms.log();
    log_weights_ = log_weights_ + kFollow * (wanted - wanted[0] - log_weights_);
  }
  log_weights_ = (log_weights_ - log_weights_[0].item<double>()).clamp(-kMostWeight, kMostWeight);
}

void LossBalance::set_state(const torch::Tensor& state) {
  TORCH_CHECK(state.sizes() == torch::IntArrayRef({2, log_weights_.size(0)}));
  log_weights_ = state[0].clone();
  first_ = state[1].clone();
}

}  // namespace understudy::training
