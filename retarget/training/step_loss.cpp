#include "retarget/training/step_loss.hpp"

namespace understudy::training {
namespace {

constexpr double kFrames = 100;   // of paper 2's movements: the divergence is weighed against their sum
constexpr double kPerMetre = 50;  // so that the divergence counts as much in both phases

/// Of squared distances [B, T], metres^2. Paper 2's eq. 2 has the squares themselves: they leave walks, which
/// are near already, to the wildest dances.
torch::Tensor surface_loss(const torch::Tensor& squared) {
  return kPerMetre * (squared + 1e-5).sqrt().mean();
}

}  // namespace

LossSum step_loss(nn::StepCvae& net, const StepBatch& batch, const torch::Tensor& noise,
                  const SurfaceDistance& surface, const StepLossOptions& options, StepBalances& balances) {
  const nn::StepCodes codes = net->encode(batch.movements);
  const auto drawn = codes.mean + noise * (0.5 * codes.log_variance).exp();
  const auto made = net->decode(drawn, batch.rest);
  const auto part = [&](int64_t first, int64_t count) {
    return part_loss(made, batch.movements, first, count);
  };
  const auto pose = part(0, kStepTurns), path = part(kStepTurns, kStepPath),
             time = part(kStepTurns + kStepPath, kStepTimes);
  const auto none = torch::zeros({});
  const auto vertices = options.on_surface ? surface_loss(surface.squared(made, batch.movements)) : none;
  std::vector<torch::Tensor> losses;
  if (options.on_surface)
    losses = {vertices};
  else
    losses = {pose, path};
  if (net->options().timed) losses.push_back(time);
  LossBalance& balance = options.on_surface ? balances.surface : balances.numbers;
  if (options.balance) balance.update(losses, drawn);
  const double numbers = options.on_surface ? 0 : 1;
  LossSum loss;  // the learning curve shows all of them in both phases
  loss.add("pose_loss", pose, numbers);
  loss.add("path_loss", path, options.on_surface ? 0 : balance.weight(1));
  loss.add("time_loss", time, net->options().timed ? balance.weight(losses.size() - 1) : 0);
  loss.add("surface_loss", vertices);
  loss.add("divergence", divergence(codes.mean, codes.log_variance), options.kl / kFrames);
  return loss;
}

}  // namespace understudy::training
