#include "retarget/training/hybrid_trainer.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/modules/joint_tensors.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/training/checkpoint_archive.hpp"

namespace understudy::training {
namespace {

constexpr double kAverageDecay = 0.998;

/// About the angle in radians between rotations [..., 3, 3], smooth at zero.
torch::Tensor angle_between(const torch::Tensor& a, const torch::Tensor& b) {
  return ((a - b).square().sum({-1, -2}) / 2 + 1e-5).sqrt();
}

torch::Tensor length(const torch::Tensor& v) {
  return (v.square().sum(-1) + 1e-8).sqrt();
}

/// Change of the change over frames [B, T, ...], as at 30 frames/s.
torch::Tensor bend(const torch::Tensor& x, const torch::Tensor& dt) {
  const auto T = x.size(1);
  const auto second = x.slice(1, 2) - 2 * x.slice(1, 1, T - 1) + x.slice(1, 0, T - 2);
  return second / (30 * dt.slice(1, 2)).square().view({x.size(0), T - 2, 1, 1});
}

/// A window as training shows it: never twice the same.
HybridWindow varied(const HybridWindow& window, Rng& rng) {
  HybridWindow other = rng.chance(0.5f) ? mirrored(window) : window;
  // Unseen people in unseen motions are extracted a little worse than those the extractor learnt from.
  other = with_scaled_errors(other, rng.chance(0.05f) ? 0.0f : rng.uniform(0.7f, 1.6f));
  if (rng.chance(0.05f))
    for (Extraction& seen : other.seen) seen.global.reset();
  return other;
}

}  // namespace

HybridBatch make_hybrid_batch(const std::vector<HybridWindow>& windows, const std::vector<Joints>& bodies,
                              Rng& rng) {
  std::vector<std::vector<nn::HybridFrame>> sequences;
  std::vector<torch::Tensor> truth, rest;
  for (const HybridWindow& window : windows) {
    const Joints& body = bodies.at(static_cast<size_t>(rng.below(static_cast<int>(bodies.size()))));
    JointFilter filter;
    nn::HybridSolve solve;
    solve.reset(body);
    auto& frames = sequences.emplace_back();
    std::vector<torch::Tensor> turned;
    for (size_t t = 0; t < window.seen.size(); ++t) {
      frames.push_back(solve.push(filter.push(window.seen[t], window.dt), window.dt));
      turned.push_back(nn::to_tensor(window.truth[t].global));
    }
    truth.push_back(torch::stack(turned));
    rest.push_back(nn::to_tensor(body));
  }
  return {nn::stack_frames(sequences), torch::stack(rest), torch::stack(truth)};
}

HybridTrainer::HybridTrainer(const HybridTrainerOptions& options, std::vector<Joints> bodies)
    : options_(options), bodies_(std::move(bodies)), rng_(options.seed) {
  US_CHECK(!bodies_.empty(), "training of hybrid wants at least one body");
  torch::manual_seed(options.seed);
  net = nn::HybridGru(options.net);
  average = nn::HybridGru(options.net);
  net->to(torch::Device(options.device));
  average->to(torch::Device(options.device));
  optimizer_ = std::make_unique<torch::optim::AdamW>(
      net->parameters(), torch::optim::AdamWOptions(options.learning_rate).betas({0.9, 0.99}));
}

HybridStep HybridTrainer::step(const std::vector<HybridWindow>& windows, double progress) {
  const double fall = 0.5 * (1 + std::cos(M_PI * std::clamp(progress, 0.0, 1.0)));
  const double warm = std::min(1.0, static_cast<double>(steps_ + 1) / 50);
  for (auto& group : optimizer_->param_groups())
    static_cast<torch::optim::AdamWOptions&>(group.options())
        .lr(options_.learning_rate * warm * (0.01 + 0.99 * fall));
  std::vector<HybridWindow> chosen;
  for (int i = 0; i < options_.batch; ++i)
    chosen.push_back(varied(windows[rng_.below(static_cast<int>(windows.size()))], rng_));
  return step(make_hybrid_batch(chosen, bodies_, rng_));
}

HybridStep HybridTrainer::step(const HybridBatch& batch) {
  const torch::Device device(options_.device);
  const auto rest = batch.rest_b.to(device), truth = batch.truth.to(device);
  const nn::HybridInput input = nn::to_device(batch.input, device);
  nn::HybridState state;
  const auto global = net->forward(input, state);
  const auto local = nn::local_rotations(global), true_local = nn::local_rotations(truth);
  const auto error =
      nn::forward_kinematics(rest, local).joints - nn::forward_kinematics(rest, true_local).joints;
  const auto rotation =
      0.5 * angle_between(global, truth).mean() + 0.5 * angle_between(local, true_local).mean();
  const auto position = length(error.slice(2, 1)).mean();
  const auto acceleration = length(bend(error, input.dt).slice(2, 1)).mean();
  const auto loss =
      rotation + options_.position_weight * position + options_.acceleration_weight * acceleration;
  US_CHECK(std::isfinite(loss.item<double>()), "training of hybrid: the loss is not finite");
  optimizer_->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(net->parameters(), 1.0);
  optimizer_->step();
  ++steps_;
  samples += input.joints.size(0) * input.joints.size(1);
  update_average();
  return {rotation.item<double>(), position.item<double>(), acceleration.item<double>()};
}

void HybridTrainer::update_average() {
  const torch::NoGradGuard no_grad;
  const auto n = static_cast<double>(steps_);
  const double decay = std::min(kAverageDecay, n / (10.0 + n));
  auto mean = average->parameters();
  const auto now = net->parameters();
  for (size_t i = 0; i < mean.size(); ++i) mean[i].lerp_(now[i], 1 - decay);
}

void HybridTrainer::save_checkpoint(const std::string& path) {
  torch::serialize::OutputArchive archive;
  put(archive, "net", *net);
  put(archive, "average", *average);
  put(archive, "optimizer", *optimizer_);
  archive.write("samples", torch::full({1}, samples, torch::kInt64));
  archive.write("steps", torch::full({1}, steps_, torch::kInt64));
  archive.write("rng", torch::full({1}, static_cast<int64_t>(rng_.state()), torch::kInt64));
  archive.write("minutes", number(minutes));
  save_archive(archive, path);
}

void HybridTrainer::load_checkpoint(const std::string& path) {
  read_archive(path, torch::Device(options_.device), [&](torch::serialize::InputArchive& archive) {
    take(archive, "net", *net);
    take(archive, "average", *average);
    take(archive, "optimizer", *optimizer_);
    samples = number_from(archive, "samples").item<int64_t>();
    steps_ = number_from(archive, "steps").item<int64_t>();
    rng_ = Rng(static_cast<uint64_t>(number_from(archive, "rng").item<int64_t>()));
    minutes = number_from(archive, "minutes").item<double>();
  });
}

HybridFigures judge_hybrid(nn::HybridGru& net, const HybridBatch& batch) {
  const torch::NoGradGuard no_grad;
  nn::HybridState state;
  const auto device = net->parameters()[0].device();
  const auto global = net->forward(nn::to_device(batch.input, device), state).cpu();
  const auto truth = nn::local_rotations(batch.truth);
  return {motion_figures(batch.rest_b, nn::local_rotations(batch.input.solved), truth),
          motion_figures(batch.rest_b, nn::local_rotations(global), truth)};
}

}  // namespace understudy::training
