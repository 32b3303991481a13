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

/// What a decoder or a distribution over z sees: the state, and how far the next key is.
torch::Tensor seen(std::vector<torch::Tensor> parts, const VrnnState& state, const AheadStep& to,
                   const torch::Tensor& dt) {
  const auto nearness =
      torch::where(to.left >= 0, 1 / (to.left + 1).clamp_min(1), torch::zeros_like(to.left));
  parts.insert(parts.end(), {state.hidden, to.summary, nearness});
  return joined(parts, dt);
}

/// Two numbers along x and z [..., 2], turned about y by angles [..., 1].
torch::Tensor turned(const torch::Tensor& xz, const torch::Tensor& angle) {
  const auto x = xz.slice(-1, 0, 1), z = xz.slice(-1, 1, 2), c = angle.cos(), s = angle.sin();
  return torch::cat({c * x + s * z, c * z - s * x}, -1);
}

}  // namespace

torch::Tensor divergence(const Gaussian& q, const Gaussian& p) {
  const auto ratio = q.deviation / p.deviation;
  const auto off = (q.mean - p.mean) / p.deviation;
  return 0.5 * (ratio.square() + off.square() - 1 - 2 * ratio.log()).sum(-1);
}

torch::Tensor squared_error(const torch::Tensor& x, const torch::Tensor& again) {
  return (x - again).square().sum({-2, -1});
}

AheadStep step_of(const Ahead& ahead, int64_t t) {
  return {ahead.curve.way.select(1, t - 1), ahead.curve.way.select(1, t), ahead.curve.left.select(1, t),
          ahead.summary.select(1, t)};
}

RotationVrnnImpl::RotationVrnnImpl(const VrnnOptions& options) : options_(options) {
  const int64_t known = options.hidden + options.ahead + 2;  // and how near the key is, and dt
  const auto net = [&](const char* name, int64_t more, int64_t out) {
    return register_module(name, two_layers(known + more, options.inner, out));
  };
  prior_ = net("prior", 0, 2 * options.latent);
  posterior_ = net("posterior", width(), 2 * options.latent);
  phi_g_ = net("phi_g", options.latent, kRoot);
  phi_r_ = net("phi_r", options.latent, width() - kRoot);
  cell_ = register_module("cell", torch::nn::GRUCell(width() + options.latent + 1, options.hidden));
  backward_ = register_module(
      "backward", torch::nn::GRU(torch::nn::GRUOptions(width() + 2, options.ahead).batch_first(true)));
  const torch::NoGradGuard no_grad;
  for (const auto& decoder : {phi_g_, phi_r_})  // at first it follows the curve, or stays as it is
    for (auto& parameter : decoder->ptr(2)->parameters()) parameter.mul_(0.01);
}

VrnnState RotationVrnnImpl::begin(int64_t batch, const torch::Device& device) const {
  auto last = torch::zeros({batch, width()}, device);
  if (!options_.positions) {
    const auto turned = torch::tensor({1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}, device);
    last.slice(-1, kRoot) = turned.repeat({options_.joints});
  }
  return {torch::zeros({batch, options_.hidden}, device), last, torch::zeros({batch, 3}, device)};
}

Ahead RotationVrnnImpl::ahead(const torch::Tensor& way, const torch::Tensor& known, const torch::Tensor& dt) {
  Ahead ahead{curve_through(way, known), {}};
  const auto& left = ahead.curve.left;
  const auto there = (left >= 0).to(way.scalar_type());
  const auto read = torch::cat(
      {rows_of(ahead.curve.way, dt) * there, left / kUsualRate, dt.unsqueeze(-1) * kUsualRate}, -1);
  const auto from_the_end = std::get<0>(backward_->forward(read.flip({1})));
  ahead.summary = from_the_end.flip({1}) * there;
  return ahead;
}

AheadStep RotationVrnnImpl::nothing_ahead(int64_t batch, const torch::Device& device) const {
  const auto none = torch::zeros({batch, width()}, device);
  return {none, none, torch::full({batch, 1}, -1.0f, device), torch::zeros({batch, options_.ahead}, device)};
}

Gaussian RotationVrnnImpl::prior(const VrnnState& state, const AheadStep& to, const torch::Tensor& dt) {
  return gaussian(prior_->forward(seen({}, state, to, dt)));
}

Gaussian RotationVrnnImpl::posterior(const VrnnState& state, const torch::Tensor& x, const AheadStep& to,
                                     const torch::Tensor& dt) {
  return gaussian(posterior_->forward(seen({x}, state, to, dt)));
}

torch::Tensor RotationVrnnImpl::decoded(const torch::Tensor& z, const VrnnState& state, const AheadStep& to,
                                        const torch::Tensor& dt) {
  const auto what = seen({z}, state, to, dt);
  const auto root = phi_g_->forward(what);
  const auto heading = state.place.slice(-1, 2);
  const auto change = torch::cat({turned(root.slice(-1, 0, 2), heading) * dt, root.slice(-1, 2, 3) * dt,
                                  root.slice(-1, 3), phi_r_->forward(what)},
                                 -1);
  const auto before = torch::cat({state.place, state.last.slice(-1, 3)}, -1);
  const auto has_key = to.left >= 0;
  const auto free = torch::where(has_key, to.left / (to.left + 1).clamp_min(1), torch::ones_like(to.left));
  const auto kept = torch::where(has_key, to.to + free * (before - to.from), before);
  const auto way = kept + free * change;
  auto pose = way.slice(-1, kRoot);
  if (!options_.positions)
    pose = rotations_to_6d(rotations_from_6d(pose.unflatten(-1, {options_.joints, 6}))).flatten(-2);
  const auto gone = way.slice(-1, 0, 3) - state.place;
  const auto speeds = torch::cat({turned(gone.slice(-1, 0, 2), -heading), gone.slice(-1, 2)}, -1) / dt;
  return torch::cat({speeds, way.slice(-1, 3, kRoot), pose}, -1);
}

void RotationVrnnImpl::advance(const torch::Tensor& row, const torch::Tensor& z, const torch::Tensor& dt,
                               VrnnState& state) {
  state.hidden = cell_->forward(joined({row, z}, dt), state.hidden);
  const auto gone =
      torch::cat({turned(row.slice(-1, 0, 2), state.place.slice(-1, 2)), row.slice(-1, 2, 3)}, -1);
  state.place = state.place + gone * dt;
  state.last = row;
}

torch::Tensor row_turns(const torch::Tensor& rows) {
  return rotations_from_6d(rows.slice(-1, RotationVrnnImpl::kRoot).unflatten(-1, {-1, 6}));
}

torch::Tensor row_places(const RotationVrnnImpl& net, const torch::Tensor& rows, const torch::Tensor& rest,
                         const std::vector<int>& parents) {
  if (net.options().positions) return rows.slice(-1, RotationVrnnImpl::kRoot).unflatten(-1, {-1, 3});
  return forward_kinematics(rest, row_turns(rows), parents).joints;
}

torch::Tensor way_of(const torch::Tensor& rows, const torch::Tensor& dt) {
  const auto none = torch::zeros_like(rows.slice(1, 0, 1).slice(-1, 0, 1));
  const auto steps = dt.slice(1, 1).unsqueeze(-1), speeds = rows.slice(1, 1);
  const auto headings = torch::cat({none, (speeds.slice(-1, 2, 3) * steps).cumsum(1)}, 1);
  const auto gone = turned(speeds.slice(-1, 0, 2), headings.slice(1, 0, -1)) * steps;
  const auto places = torch::cat({none.expand({-1, -1, 2}), gone.cumsum(1)}, 1);
  return torch::cat({places, headings, rows.slice(-1, 3)}, -1);
}

torch::Tensor rows_of(const torch::Tensor& way, const torch::Tensor& dt) {
  const auto gone = way.slice(1, 1).slice(-1, 0, 3) - way.slice(1, 0, -1).slice(-1, 0, 3);
  const auto headings = way.slice(1, 0, -1).slice(-1, 2, 3);
  const auto speeds = torch::cat({turned(gone.slice(-1, 0, 2), -headings), gone.slice(-1, 2)}, -1) /
                      dt.slice(1, 1).unsqueeze(-1);
  const auto none = torch::zeros_like(way.slice(1, 0, 1).slice(-1, 0, 3));
  return torch::cat({torch::cat({none, speeds}, 1), way.slice(-1, 3)}, -1);
}

}  // namespace understudy::nn
