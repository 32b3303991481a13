#include "retarget/training/dynamics_step.hpp"

namespace understudy::training {
namespace {

constexpr double kTurnsWeight = 0.3, kSpeedWeight = 0.05, kHeightWeight = 5, kKlWeight = 0.003;

struct Followed {
  torch::Tensor rows;       // [B, T, width]
  nn::Gaussian seen, told;  // posterior and prior, [B, T, latent]
};

Followed followed(nn::RotationVrnn& net, const torch::Tensor& rows, const torch::Tensor& dt) {
  nn::VrnnState state = net->begin(rows.size(0), rows.device());
  std::vector<torch::Tensor> made, q_mean, q_deviation, p_mean, p_deviation;
  for (int64_t t = 0; t < rows.size(1); ++t) {
    const auto step = dt.select(1, t).unsqueeze(-1);
    const nn::Gaussian p = net->prior(state, step), q = net->posterior(state, rows.select(1, t), step);
    const auto z = q.mean + q.deviation * torch::randn_like(q.mean);
    made.push_back(net->decoded(z, state, step));
    net->advance(made.back(), z, step, state);
    q_mean.push_back(q.mean), q_deviation.push_back(q.deviation);
    p_mean.push_back(p.mean), p_deviation.push_back(p.deviation);
  }
  return {torch::stack(made, 1),
          {torch::stack(q_mean, 1), torch::stack(q_deviation, 1)},
          {torch::stack(p_mean, 1), torch::stack(p_deviation, 1)}};
}

torch::Tensor thousandths_off(const torch::Tensor& a, const torch::Tensor& b) {
  return 1000 * (a - b).square().sum(-1).sqrt().mean();
}

}  // namespace

torch::Tensor squared_angles(const torch::Tensor& a, const torch::Tensor& b) {
  const auto trace = (a * b).sum({-2, -1});  // of A^T B
  return ((trace - 1) / 2).clamp(-1 + 1e-6, 1 - 1e-6).acos().square().sum(-1).mean();
}

torch::Tensor rows_for(const nn::RotationVrnnImpl& net, const DynamicsBatch& batch,
                       const std::vector<int>& parents) {
  if (!net.options().positions) return batch.rows;
  nn::VrnnOptions turned = net.options();
  turned.positions = false;
  const auto places = nn::row_places(nn::RotationVrnnImpl(turned), batch.rows, batch.rest, parents);
  return torch::cat({batch.rows.slice(-1, 0, nn::RotationVrnnImpl::kRoot), places.flatten(-2)}, -1);
}

LossSum dynamics_loss(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents) {
  const auto rows = rows_for(*net, batch, parents);
  const Followed made = followed(net, rows, batch.dt);
  LossSum loss;
  loss.add("places", nn::squared_error(nn::row_places(*net, rows, batch.rest, parents),
                                       nn::row_places(*net, made.rows, batch.rest, parents)));
  if (!net->options().positions)
    loss.add("turns", squared_angles(nn::row_turns(rows), nn::row_turns(made.rows)), kTurnsWeight);
  const auto off = (rows - made.rows).square();
  loss.add("speeds", off.slice(-1, 0, 3).slice(1, 1).sum(-1).mean(), kSpeedWeight);
  loss.add("height", off.select(-1, 3).mean(), kHeightWeight);
  loss.add("kl", nn::divergence(made.seen, made.told), kKlWeight);
  return loss;
}

Figures dynamics_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents) {
  const torch::NoGradGuard no_grad;
  constexpr int64_t kGiven = 10, kAhead = 10;
  const auto rows = rows_for(*net, batch, parents);
  nn::VrnnState state = net->begin(rows.size(0), rows.device());
  std::vector<torch::Tensor> made;
  torch::Tensor kl = torch::zeros({});
  for (int64_t t = 0; t < kGiven + kAhead; ++t) {
    const auto step = batch.dt.select(1, t).unsqueeze(-1);
    const nn::Gaussian p = net->prior(state, step), q = net->posterior(state, rows.select(1, t), step);
    if (t < kGiven) kl = kl + nn::divergence(q, p) / kGiven;
    const auto z = t < kGiven ? q.mean : p.mean;
    made.push_back(net->decoded(z, state, step));
    net->advance(made.back(), z, step, state);
  }
  const auto truth = nn::row_places(*net, rows.slice(1, 0, kGiven + kAhead), batch.rest, parents),
             found = nn::row_places(*net, torch::stack(made, 1), batch.rest, parents);
  const auto still = truth.select(1, kGiven - 1);
  return {
      {"dev_kl", kl.item<double>()},
      {"seen", thousandths_off(truth.slice(1, 0, kGiven), found.slice(1, 0, kGiven)).item<double>()},
      {"ahead", thousandths_off(truth.select(1, kGiven + kAhead - 1), found.select(1, kGiven + kAhead - 1))
                    .item<double>()},
      {"ahead_still", thousandths_off(truth.select(1, kGiven + kAhead - 1), still).item<double>()}};
}

}  // namespace understudy::training
