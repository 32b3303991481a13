#include "retarget/nn/modules/rotation_vrnn.hpp"

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::nn {
namespace {

constexpr double kLeastDeviation = 1e-4;
constexpr double kUsualRate = 30;  // frames a second that times are told in

torch::nn::Sequential two_layers(int64_t in, int64_t inner, int64_t out) {
  return torch::nn::Sequential(torch::nn::Linear(in, inner), torch::nn::LeakyReLU(),
                               torch::nn::Linear(inner, out));
}

Gaussian gaussian(const torch::Tensor& numbers) {
  const auto parts = numbers.chunk(2, -1);
  return {parts[0], torch::nn::functional::softplus(parts[1]) + kLeastDeviation};
}

torch::Tensor joined(const std::vector<torch::Tensor>& parts, const torch::Tensor& dt) {
  std::vector<torch::Tensor> all = parts;
  all.push_back(dt * kUsualRate);
  return torch::cat(all, -1);
}

}  // namespace

torch::Tensor divergence(const Gaussian& q, const Gaussian& p) {
  const auto ratio = q.deviation / p.deviation;
  const auto off = (q.mean - p.mean) / p.deviation;
  return 0.5 * (ratio.square() + off.square() - 1 - 2 * ratio.log()).sum(-1).mean();
}

torch::Tensor squared_error(const torch::Tensor& x, const torch::Tensor& again) {
  return (x - again).square().sum({-2, -1}).mean();
}

RotationVrnnImpl::RotationVrnnImpl(const VrnnOptions& options)
    : options_(options),
      prior_(register_module("prior", two_layers(options.hidden + 1, options.inner, 2 * options.latent))),
      posterior_(register_module(
          "posterior", two_layers(options.hidden + width() + 1, options.inner, 2 * options.latent))),
      phi_g_(register_module("phi_g", two_layers(options.latent + options.hidden + 1, options.inner, kRoot))),
      phi_r_(register_module(
          "phi_r", two_layers(options.latent + options.hidden + 1, options.inner, width() - kRoot))),
      cell_(register_module("cell", torch::nn::GRUCell(width() + options.latent + 1, options.hidden))) {}

VrnnState RotationVrnnImpl::begin(int64_t batch, const torch::Device& device) const {
  auto last = torch::zeros({batch, width()}, device);
  if (!options_.positions) {
    const auto turned = torch::tensor({1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}, device);
    last.slice(-1, kRoot) = turned.repeat({options_.joints});
  }
  return {torch::zeros({batch, options_.hidden}, device), last};
}

Gaussian RotationVrnnImpl::prior(const VrnnState& state, const torch::Tensor& dt) {
  return gaussian(prior_->forward(joined({state.hidden}, dt)));
}

Gaussian RotationVrnnImpl::posterior(const VrnnState& state, const torch::Tensor& x,
                                     const torch::Tensor& dt) {
  return gaussian(posterior_->forward(joined({state.hidden, x}, dt)));
}

torch::Tensor RotationVrnnImpl::decoded(const torch::Tensor& z, const VrnnState& state,
                                        const torch::Tensor& dt) {
  const auto seen = joined({z, state.hidden}, dt);
  const auto root = phi_g_->forward(seen);
  const auto height = state.last.slice(-1, kRoot - 1, kRoot) + root.slice(-1, kRoot - 1);
  auto pose = state.last.slice(-1, kRoot) + phi_r_->forward(seen);
  if (!options_.positions)
    pose = rotations_to_6d(rotations_from_6d(pose.unflatten(-1, {options_.joints, 6}))).flatten(-2);
  return torch::cat({root.slice(-1, 0, kRoot - 1), height, pose}, -1);
}

void RotationVrnnImpl::advance(const torch::Tensor& decoded, const torch::Tensor& z, const torch::Tensor& dt,
                               VrnnState& state) {
  state.hidden = cell_->forward(joined({decoded, z}, dt), state.hidden);
  state.last = decoded;
}

torch::Tensor row_turns(const torch::Tensor& rows) {
  return rotations_from_6d(rows.slice(-1, RotationVrnnImpl::kRoot).unflatten(-1, {-1, 6}));
}

torch::Tensor row_places(const RotationVrnnImpl& net, const torch::Tensor& rows, const torch::Tensor& rest,
                         const std::vector<int>& parents) {
  if (net.options().positions) return rows.slice(-1, RotationVrnnImpl::kRoot).unflatten(-1, {-1, 3});
  return forward_kinematics(rest, row_turns(rows), parents).joints;
}

RootWay root_way(const torch::Tensor& rows, const torch::Tensor& dt) {
  const auto none = torch::zeros_like(dt.slice(1, 0, 1));
  const auto steps = dt.slice(1, 1);
  const auto turned = (rows.select(-1, 2).slice(1, 1) * steps).cumsum(1);
  const auto headings = torch::cat({none, turned}, 1);
  const auto before = headings.slice(1, 0, headings.size(1) - 1);
  const auto c = before.cos(), s = before.sin();
  const auto vx = rows.select(-1, 0).slice(1, 1) * steps, vz = rows.select(-1, 1).slice(1, 1) * steps;
  const auto x = torch::cat({none, (c * vx + s * vz).cumsum(1)}, 1),
             z = torch::cat({none, (c * vz - s * vx).cumsum(1)}, 1);
  return {headings, torch::stack({x, rows.select(-1, 3), z}, -1)};
}

}  // namespace understudy::nn
