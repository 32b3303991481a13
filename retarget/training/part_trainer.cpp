#include "retarget/training/part_trainer.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/part_refiner.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/checkpoint_archive.hpp"
#include "retarget/training/parameters.hpp"
#include "retarget/training/part_data.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kLearningRate = 1e-3;
constexpr int kWarmUpSteps = 200, kScansAStep = 24, kDevScans = 120;
constexpr double kAverageDecay = 0.998, kSecondsPerCheckpoint = 120, kSecondsPerReport = 120;

/// Mean angle in degrees between the rotations of what is told of the first joints.
double mean_angle(const torch::Tensor& said, const torch::Tensor& truth) {
  const auto a = said.contiguous(), b = truth.contiguous();
  double sum = 0;
  for (int64_t i = 0; i < a.size(0); ++i) {
    const float *one = a.data_ptr<float>() + i * a.stride(0), *other = b.data_ptr<float>() + i * b.stride(0);
    sum += geodesic_angle(rotation_from_6d(Eigen::Map<const Vec6>(one)),
                          rotation_from_6d(Eigen::Map<const Vec6>(other)));
  }
  return sum / static_cast<double>(std::max<int64_t>(1, a.size(0))) * 180 / kPi;
}

/// How far the places are off, [B, K], in leg lengths.
torch::Tensor distances(const torch::Tensor& said, const torch::Tensor& truth) {
  return (said.narrow(2, 6, 3) - truth.narrow(2, 6, 3)).square().sum(2).add(1e-8).sqrt();
}

torch::Tensor part_loss(const torch::Tensor& said, const torch::Tensor& truth) {
  const auto turn = (said.narrow(2, 0, 6) - truth.narrow(2, 0, 6)).abs().mean();
  const auto away = distances(said, truth);
  const auto log_spread = said.select(2, 9);
  const auto spread = (away.detach() * torch::exp(-log_spread) + log_spread).mean();
  return turn + 5 * away.mean() + 0.01 * spread;
}

/// Of every kind, before and after looking: degrees of its first joint, how far off its two joints, leg
/// lengths.
std::string curve_header() {
  std::string header = "minutes,step,samples,rate,loss";
  for (const char* kind : {"hand", "head", "foot", "arm", "leg"})
    for (const char* what : {"deg", "first", "second"})
      header += detail::join(",", kind, "_", what, "_before,", kind, "_", what);
  return header;
}

class PartTrainer {
 public:
  explicit PartTrainer(const nn::TrainOptions& options);
  int run();

 private:
  void resume();
  void save_checkpoint();
  void train_step(const PartBatches& batches);
  void report();
  double done_share() const;
  double learning_rate() const;
  std::string checkpoint() const { return options_.out + ".checkpoint"; }

  nn::TrainOptions options_;
  TrainingData train_, dev_;
  std::unique_ptr<PartSampler> sampler_;
  PartBatches dev_batches_;
  nn::PartRefinerNet net_, average_, first_;  // first_: what training started from
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  int64_t step_ = 0, samples_ = 0;
  double seconds_ = 0, seconds_before_ = 0, loss_sum_ = 0;
  int loss_count_ = 0;
  Clock::time_point started_ = Clock::now();
};

PartTrainer::PartTrainer(const nn::TrainOptions& options)
    : options_(options),
      train_(load_training_data(options.data, Split::Train)),
      dev_(load_training_data(options.data, Split::Dev)),
      sampler_(std::make_unique<PartSampler>(train_, options.seed)),
      dev_batches_(PartSampler(dev_, 12345).next(kDevScans)) {
  US_CHECK(options_.minutes > 0 || options_.samples > 0, "training wants --minutes or --samples");
  at::set_num_threads(1);
  torch::manual_seed(options_.seed);
  net_ = nn::PartRefinerNet();
  average_ = nn::PartRefinerNet();
  if (!options_.init.empty()) nn::load_weights(options_.init, nn::kPartFileKind, nn::kPartVersion, *net_);
  copy_parameters(*net_, *average_);
  if (options_.keep > 0) copy_parameters(*net_, *first_);
  optimizer_ = std::make_unique<torch::optim::AdamW>(
      net_->parameters(), torch::optim::AdamWOptions(kLearningRate).weight_decay(1e-4));
  resume();
}

void PartTrainer::resume() {
  if (!fs::exists(checkpoint())) return;
  TrainingProgress progress;
  read_archive(checkpoint(), c10::nullopt, [&](torch::serialize::InputArchive& archive) {
    progress = take_training(archive, *net_, *average_, *optimizer_);
  });
  step_ = progress.step;
  samples_ = progress.samples;
  seconds_before_ = seconds_ = progress.seconds;
  // Other scans than those that were seen before.
  sampler_ = std::make_unique<PartSampler>(train_, options_.seed + static_cast<uint64_t>(step_) * 7919);
  log::info("resumed " + checkpoint() + " at step " + std::to_string(step_));
}

void PartTrainer::save_checkpoint() {
  torch::serialize::OutputArchive archive;
  put_training(archive, *net_, *average_, *optimizer_, {step_, samples_, seconds_});
  save_archive(archive, checkpoint());
  nn::PartRefinerNet kept;
  copy_parameters(*average_, *kept);
  if (options_.keep > 0) mix_parameters(*first_, *kept, options_.keep);
  nn::save_weights(
      options_.out,
      {nn::kPartFileKind, nn::kPartVersion, {{"samples", samples_}, {"steps", step_}, {"seconds", seconds_}}},
      *kept);
}

double PartTrainer::done_share() const {
  const double by_time = options_.minutes > 0 ? seconds_ / (60 * options_.minutes) : 0;
  const double by_samples =
      options_.samples > 0 ? static_cast<double>(samples_) / static_cast<double>(options_.samples) : 0;
  return std::max(by_time, by_samples);
}

double PartTrainer::learning_rate() const {
  const double warm = std::min(1.0, static_cast<double>(step_ + 1) / kWarmUpSteps);
  return kLearningRate * warm * (0.01 + 0.99 * 0.5 * (1 + std::cos(kPi * std::min(1.0, done_share()))));
}

void PartTrainer::train_step(const PartBatches& batches) {
  optimizer_->zero_grad();
  auto loss = torch::zeros({});
  for (int kind = 0; kind < nn::kPartKinds; ++kind) {
    const PartBatch& batch = batches[static_cast<size_t>(kind)];
    if (batch.points.size(0) == 0) continue;
    const auto said = net_->of(static_cast<nn::PartKind>(kind))->forward(batch.points, batch.context);
    loss = loss + part_loss(said, batch.truth);
  }
  loss.backward();
  for (auto& group : optimizer_->param_groups())
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(learning_rate());
  const double norm = torch::nn::utils::clip_grad_norm_(net_->parameters(), /*max_norm=*/1.0);
  if (std::isfinite(norm)) optimizer_->step();
  const torch::NoGradGuard no_grad;
  const double decay =
      std::min(kAverageDecay, static_cast<double>(1 + step_) / static_cast<double>(10 + step_));
  auto averaged = average_->parameters();
  const auto now = net_->parameters();
  for (size_t i = 0; i < averaged.size(); ++i) averaged[i].lerp_(now[i], 1 - decay);
  ++step_;
  loss_sum_ += loss.item<double>();
  ++loss_count_;
  seconds_ = seconds_before_ + std::chrono::duration<double>(Clock::now() - started_).count();
}

void PartTrainer::report() {
  const torch::NoGradGuard no_grad;
  std::string row;
  char number[64];
  for (size_t kind = 0; kind < nn::kPartKinds; ++kind) {
    const PartBatch& batch = dev_batches_[kind];
    const auto said = average_->of(static_cast<nn::PartKind>(kind))->forward(batch.points, batch.context);
    const auto now = distances(said, batch.truth).mean(0), was = distances(batch.before, batch.truth).mean(0);
    std::snprintf(number, sizeof number, ",%.2f,%.2f", mean_angle(batch.before, batch.truth),
                  mean_angle(said, batch.truth));
    row += number;
    for (int64_t k = 0; k < nn::kPartJoints; ++k) {
      std::snprintf(number, sizeof number, ",%.4f,%.4f", was[k].item<double>(), now[k].item<double>());
      row += number;
    }
  }
  char line[120];
  std::snprintf(line, sizeof line, "%.1f,%lld,%lld,%.6f,%.4f", seconds_ / 60, static_cast<long long>(step_),
                static_cast<long long>(samples_), learning_rate(), loss_sum_ / std::max(1, loss_count_));
  loss_sum_ = loss_count_ = 0;
  const std::string curve = options_.curve.empty() ? options_.out + ".csv" : options_.curve;
  const bool fresh = !fs::exists(curve);
  std::ofstream out(curve, std::ios::app);
  if (fresh) out << curve_header() << "\n";
  out << line << row << "\n";
  log::info(std::string("part ") + line + row);
}

int PartTrainer::run() {
  double last_checkpoint = seconds_, last_report = seconds_;
  const int scans = options_.batch > 0 ? options_.batch : kScansAStep;
  const auto make = [&] { return sampler_->next(scans); };
  // The next scans are made while the network learns from these.
  auto coming = std::async(std::launch::async, make);
  while (done_share() < 1 && !(options_.cancelled && options_.cancelled())) {
    const PartBatches batches = coming.get();
    coming = std::async(std::launch::async, make);
    train_step(batches);
    samples_ += scans;
    if (step_ == 20 || seconds_ - last_report >= kSecondsPerReport) {
      report();
      last_report = seconds_;
    }
    if (seconds_ - last_checkpoint >= kSecondsPerCheckpoint) {
      save_checkpoint();
      last_checkpoint = seconds_;
    }
  }
  coming.wait();
  save_checkpoint();
  report();
  return done_share() < 1 ? 1 : 0;
}

}  // namespace

int train_part(const nn::TrainOptions& options) {
  return PartTrainer(options).run();
}

}  // namespace understudy::training
