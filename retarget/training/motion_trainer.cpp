#include "retarget/training/motion_trainer.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/training/checkpoint_archive.hpp"
#include "retarget/training/losses/motion_losses.hpp"

namespace understudy::training {
namespace {

void set_rate(torch::optim::Adam& optimizer, double rate) {
  for (auto& group : optimizer.param_groups())
    static_cast<torch::optim::AdamOptions&>(group.options()).lr(rate);
}

MotionBatch on_device(MotionBatch batch, const std::string& device) {
  if (device == "cpu") return batch;
  for (auto* tensor : {&batch.joints, &batch.leg, &batch.dt, &batch.clean, &batch.rotations, &batch.rest_a,
                       &batch.rest_b, &batch.seen_b, &batch.real})
    *tensor = tensor->to(torch::Device(device));
  return batch;
}

}  // namespace

MotionTrainer::MotionTrainer(const MotionTrainerOptions& options) : options_(options), rng_(options.seed) {
  torch::manual_seed(options.seed);
  net = nn::MotionGru(options.net);
  discriminator = MotionDiscriminator();
  const torch::Device device(options.device);
  net->to(device);
  discriminator->to(device);
  optimizer_ = std::make_unique<torch::optim::Adam>(net->parameters(),
                                                    torch::optim::AdamOptions(options.learning_rate));
  telling_optimizer_ = std::make_unique<torch::optim::Adam>(
      discriminator->parameters(), torch::optim::AdamOptions(options.telling_rate).betas({0.5, 0.99}));
}

MotionStep MotionTrainer::step(const MotionData& data, double progress) {
  const double fall = 0.5 * (1 + std::cos(M_PI * std::clamp(progress, 0.0, 1.0)));
  set_rate(*optimizer_, options_.learning_rate * (0.01 + 0.99 * fall));
  return step(data.batch(options_.batch, rng_));
}

MotionStep MotionTrainer::step(const MotionBatch& batch) {
  samples += batch.joints.size(0);
  return learn(on_device(batch, options_.device));
}

MotionStep MotionTrainer::learn(const MotionBatch& batch) {
  const int64_t crossed = batch.crossed;
  nn::MotionState there, back;
  const auto local_b = net->forward({batch.joints, batch.leg, batch.dt, batch.seen_b}, there);  // A to B
  const auto made = nn::forward_kinematics(batch.rest_b, local_b).joints;
  const auto made_b = made.slice(0, 0, crossed);  // another body: no truth is known
  auto rotations = local_b.slice(0, crossed);     // B is A: these already came back
  auto joints = made.slice(0, crossed);
  if (crossed > 0) {
    const auto leg_b =
        nn::leg_lengths(batch.rest_b.slice(0, 0, crossed)).unsqueeze(1).expand({crossed, made.size(1)});
    const auto rest_a = batch.rest_a.slice(0, 0, crossed);
    const auto local_a =
        net->forward({made_b, leg_b, batch.dt.slice(0, 0, crossed), rest_a}, back);  // and back to A
    rotations = torch::cat({local_a, rotations});
    joints = torch::cat({nn::forward_kinematics(rest_a, local_a).joints, joints});
  }

  const auto cycle = cycle_loss(joints, batch.clean);
  const auto rotation = rotation_loss(rotations, batch.rotations);
  const auto smoothness = smoothness_loss(joints, batch.clean, batch.dt);
  auto loss = cycle + options_.rotation_weight * rotation + options_.smoothness_weight * smoothness;
  MotionStep report{cycle.item<double>(), rotation.item<double>(), smoothness.item<double>(), 0, 0};
  if (crossed > 0) {
    const auto adversarial = fooling_loss(
        discriminator->forward(made_b, batch.rest_b.slice(0, 0, crossed), batch.dt.slice(0, 0, crossed)));
    loss = loss + options_.adversarial_weight * adversarial;
    report.adversarial = adversarial.item<double>();
  }
  US_CHECK(std::isfinite(loss.item<double>()), "training of motion transfer: the loss is not finite");
  optimizer_->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(net->parameters(), 0.1);
  optimizer_->step();
  if (crossed > 0) report.accuracy = tell_apart(batch, made_b.detach());
  return report;
}

double MotionTrainer::tell_apart(const MotionBatch& batch, const torch::Tensor& made) {
  const auto rest = batch.rest_b.slice(0, 0, batch.crossed);
  const auto dt = batch.dt.slice(0, 0, batch.crossed);
  const auto real_scores = discriminator->forward(batch.real, rest, dt);
  const auto fake_scores = discriminator->forward(made, rest, dt);
  telling_optimizer_->zero_grad();
  telling_loss(real_scores, fake_scores).backward();
  telling_optimizer_->step();
  return telling_accuracy(real_scores, fake_scores);
}

void MotionTrainer::save_checkpoint(const std::string& path) {
  torch::serialize::OutputArchive archive;
  put(archive, "net", *net);
  put(archive, "discriminator", *discriminator);
  put(archive, "optimizer", *optimizer_);
  put(archive, "telling_optimizer", *telling_optimizer_);
  archive.write("samples", torch::full({1}, samples, torch::kInt64));
  archive.write("rng", torch::full({1}, static_cast<int64_t>(rng_.state()), torch::kInt64));
  archive.write("minutes", number(minutes));
  save_archive(archive, path);
}

void MotionTrainer::load_checkpoint(const std::string& path) {
  read_archive(path, torch::Device(options_.device), [&](torch::serialize::InputArchive& archive) {
    take(archive, "net", *net);
    take(archive, "discriminator", *discriminator);
    take(archive, "optimizer", *optimizer_);
    take(archive, "telling_optimizer", *telling_optimizer_);
    samples = number_from(archive, "samples").item<int64_t>();
    rng_ = Rng(static_cast<uint64_t>(number_from(archive, "rng").item<int64_t>()));
    minutes = number_from(archive, "minutes").item<double>();
  });
}

}  // namespace understudy::training
