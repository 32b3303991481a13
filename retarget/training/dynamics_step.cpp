#include "retarget/training/dynamics_step.hpp"

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::training {
namespace {

constexpr double kTurnsWeight = 0.07, kSpeedWeight = 0.05, kHeightWeight = 5, kGoneWeight = 5,
                 kKlWeight = 0.01;
constexpr double kRushWeight = 0.03, kStanding = 3;
constexpr double kStandsBelow = 0.1;  // sizes a second

/// Of vectors or matrices, with a gradient at 0.
torch::Tensor length(const torch::Tensor& of, const std::vector<int64_t>& axes) {
  return of.square().sum(axes).add(1e-8).sqrt();
}

struct Followed {
  torch::Tensor rows;     // [B, T, width]
  torch::Tensor diverge;  // [B, T] of the posterior from the prior
};

/// by_prior [B, T]: 1 where z is the prior's mean, 0 where it is drawn from the posterior. Known frames are
/// as they are.
Followed followed(nn::RotationVrnn& net, const DynamicsBatch& batch, const torch::Tensor& rows,
                  const torch::Tensor& by_prior) {
  const bool has_keys = batch.known.select(1, -1).any().item<bool>();
  const bool posterior = (by_prior < 1).any().item<bool>();
  const nn::Ahead ahead =
      has_keys ? net->ahead(nn::way_of(rows, batch.dt), batch.known, batch.dt) : nn::Ahead{};
  const nn::AheadStep nothing = net->nothing_ahead(rows.size(0), rows.device());
  const auto known = batch.known.to(rows.device()).unsqueeze(-1);
  nn::VrnnState state = net->begin(rows.size(0), rows.device());
  std::vector<torch::Tensor> made, diverge;
  for (int64_t t = 0; t < rows.size(1); ++t) {
    const auto step = batch.dt.select(1, t).unsqueeze(-1), x = rows.select(1, t);
    const nn::AheadStep to = has_keys && t > 0 ? nn::step_of(ahead, t) : nothing;
    const nn::Gaussian p = net->prior(state, to, step);
    auto z = p.mean;
    if (posterior) {
      const nn::Gaussian q = net->posterior(state, x, to, step);
      const auto told = by_prior.slice(1, t, t + 1);
      z = told * p.mean + (1 - told) * (q.mean + q.deviation * torch::randn_like(q.mean));
      diverge.push_back((1 - told.squeeze(1)) * nn::divergence(q, p));
    } else {
      diverge.push_back(torch::zeros_like(by_prior.select(1, t)));
    }
    made.push_back(torch::where(known.select(1, t), x, net->decoded(z, state, to, step)));
    net->advance(made.back(), z, step, state);
  }
  return {torch::stack(made, 1), torch::stack(diverge, 1)};
}

/// All frames by the prior's means.
torch::Tensor told(nn::RotationVrnn& net, const DynamicsBatch& batch, const torch::Tensor& rows) {
  return followed(net, batch, rows, torch::ones_like(batch.dt)).rows;
}

torch::Tensor joints_of(const nn::RotationVrnnImpl& net, const torch::Tensor& rows,
                        const DynamicsBatch& batch, const std::vector<int>& parents) {
  return world_places(nn::way_of(rows, batch.dt), nn::row_places(net, rows, batch.rest, parents));
}

/// [B, T]
torch::Tensor thousandths_off(const torch::Tensor& a, const torch::Tensor& b) {
  return 1000 * (a - b).square().sum(-1).sqrt().mean(-1);
}

}  // namespace

torch::Tensor turn_error(const torch::Tensor& a, const torch::Tensor& b) {
  return length(a - b, {-2, -1}).sum(-1);  // Frobenius norm
}

torch::Tensor rows_for(const nn::RotationVrnnImpl& net, const DynamicsBatch& batch,
                       const std::vector<int>& parents) {
  if (!net.options().positions) return batch.rows;
  const auto places = nn::forward_kinematics(batch.rest, nn::row_turns(batch.rows), parents).joints;
  return torch::cat({batch.rows.slice(-1, 0, nn::RotationVrnnImpl::kRoot), places.flatten(-2)}, -1);
}

torch::Tensor world_places(const torch::Tensor& way, const torch::Tensor& places) {
  const auto heading = way.slice(-1, 2, 3);
  const auto c = heading.cos(), s = heading.sin();
  const auto x = places.select(-1, 0), y = places.select(-1, 1), z = places.select(-1, 2);
  return torch::stack(
      {c * x + s * z + way.slice(-1, 0, 1), y + way.slice(-1, 3, 4), c * z - s * x + way.slice(-1, 1, 2)},
      -1);
}

torch::Tensor velocity_error(const torch::Tensor& truth, const torch::Tensor& made) {
  const auto stands = torch::exp(-(truth.square().sum(-1) / (kStandsBelow * kStandsBelow)));
  return ((1 + kStanding * stands) * length(truth - made, {-1})).sum(-1);
}

LossSum dynamics_loss(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents) {
  const auto rows = rows_for(*net, batch, parents);
  const auto known = batch.known.to(rows.device());
  const auto keyed = known.select(1, -1).unsqueeze(-1);  // [B, 1]
  const auto third = (torch::arange(rows.size(0), rows.device()) % 3 > 0).unsqueeze(-1);
  const Followed made = followed(net, batch, rows, (known | (keyed & third)).to(rows.scalar_type()));
  const auto true_places = nn::row_places(*net, rows, batch.rest, parents),
             places = nn::row_places(*net, made.rows, batch.rest, parents);
  const auto true_way = nn::way_of(rows, batch.dt), way = nn::way_of(made.rows, batch.dt);
  LossSum loss;
  loss.add("places", nn::squared_error(true_places, places).mean());
  if (!net->options().positions)
    loss.add("turns", turn_error(nn::row_turns(rows), nn::row_turns(made.rows)).mean(), kTurnsWeight);
  loss.add("speeds", (rows - made.rows).slice(1, 1).slice(-1, 0, 3).square().sum(-1).mean(), kSpeedWeight);
  const auto off = true_way - way;
  loss.add("height", off.select(-1, 3).square().mean(), kHeightWeight);
  const auto astray = off.slice(-1, 0, 2).square().sum(-1) + 1 - off.select(-1, 2).cos();
  loss.add("way", (keyed * astray).mean(), kGoneWeight);  // without keys it may go elsewhere
  const auto steps = batch.dt.slice(1, 1).unsqueeze(-1).unsqueeze(-1);
  const auto velocity = [&](const torch::Tensor& of, const torch::Tensor& at) {
    return world_places(of, at).diff(1, 1) / steps;
  };
  loss.add("velocities", velocity_error(velocity(true_way, true_places), velocity(way, places)).mean(),
           kRushWeight);
  loss.add("kl", made.diverge.mean(), kKlWeight);
  return loss;
}

Figures between_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents) {
  const torch::NoGradGuard no_grad;
  const auto rows = rows_for(*net, batch, parents);
  const auto truth = joints_of(*net, rows, batch, parents);
  const auto between = batch.known.logical_not().to(rows.device(), rows.scalar_type());
  const auto off = [&](const torch::Tensor& made) {
    const auto of_frames = thousandths_off(joints_of(*net, made, batch, parents), truth);
    return ((of_frames * between).sum() / between.sum()).item<double>();
  };
  const auto curve = nn::curve_through(nn::way_of(rows, batch.dt), batch.known).way;
  return {{"between", off(told(net, batch, rows))}, {"between_curve", off(nn::rows_of(curve, batch.dt))}};
}

Figures ahead_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents) {
  const torch::NoGradGuard no_grad;
  constexpr int64_t kAhead = 10;
  const auto rows = rows_for(*net, batch, parents);
  const auto last = batch.known.to(torch::kLong).sum(1) - 1;  // that is given
  const auto of = [&](const torch::Tensor& joints, int64_t later) {
    const auto index = (last + later).to(joints.device()).view({-1, 1, 1, 1});
    return joints.gather(1, index.expand({-1, 1, joints.size(2), 3}));
  };
  const auto truth = joints_of(*net, rows, batch, parents),
             found = joints_of(*net, told(net, batch, rows), batch, parents);
  const auto wanted = of(truth, kAhead);
  return {{"ahead", thousandths_off(of(found, kAhead), wanted).mean().item<double>()},
          {"ahead_still", thousandths_off(of(truth, 0), wanted).mean().item<double>()}};
}

}  // namespace understudy::training
