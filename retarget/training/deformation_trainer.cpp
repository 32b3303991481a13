#include "retarget/training/deformation_trainer.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/checkpoint_archive.hpp"
#include "retarget/training/deformation_step.hpp"
#include "retarget/training/parameters.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kLearningRate = 2e-3;
constexpr int kWarmUpSteps = 200;
constexpr double kAverageDecay = 0.998;
constexpr double kSecondsPerCheckpoint = 120;
constexpr double kSecondsPerReport = 600;

class DeformationTrainer {
 public:
  explicit DeformationTrainer(const nn::TrainOptions& options);
  int run();

 private:
  void resume();
  void save_checkpoint();
  void train_step();
  void update_average();
  void report();
  double done_share() const;
  double learning_rate() const;
  DeformationBatch next_batch();

  nn::TrainOptions options_;
  torch::Device device_;
  TrainingData train_, dev_;
  DeformationEvaluator evaluator_;
  nn::DeformationNet net_, average_;
  std::vector<torch::Tensor> parameters_;
  std::unique_ptr<torch::optim::Adam> optimizer_;
  std::unique_ptr<DeformationSampler> sampler_;
  int64_t step_ = 0, samples_ = 0;
  double seconds_ = 0, seconds_before_ = 0;
  Clock::time_point started_ = Clock::now();
  DeformationLoss sum_;
  int sum_count_ = 0;
};

DeformationTrainer::DeformationTrainer(const nn::TrainOptions& options)
    : options_(options),
      device_(options.device),
      train_(load_training_data(options.data, Split::Train)),
      dev_(load_training_data(options.data, Split::Dev)),
      evaluator_(dev_) {
  US_CHECK(options_.minutes > 0 || options_.samples > 0, "training wants --minutes or --samples");
  at::set_num_threads(std::max(1, options_.threads));
  torch::manual_seed(options_.seed);
  net_ = nn::DeformationNet();
  average_ = nn::DeformationNet();
  if (!options_.init.empty()) nn::load_weights(options_.init, "deformation", nn::kDeformationVersion, *net_);
  net_->to(device_);
  copy_parameters(*net_, *average_);
  parameters_ = net_->parameters();
  optimizer_ = std::make_unique<torch::optim::Adam>(
      parameters_, torch::optim::AdamOptions(kLearningRate).betas({0.9, 0.98}));
  DeformationDataOptions data;
  if (options_.batch > 0) data.bodies = options_.batch;
  sampler_ = std::make_unique<DeformationSampler>(train_, data, options_.seed);
  resume();
}

std::string checkpoint_path(const nn::TrainOptions& options) {
  return options.out + ".checkpoint";
}

void DeformationTrainer::resume() {
  const std::string path = checkpoint_path(options_);
  if (!fs::exists(path)) return;
  TrainingProgress progress;
  read_archive(path, c10::nullopt, [&](torch::serialize::InputArchive& archive) {
    progress = take_training(archive, *net_, *average_, *optimizer_);
    sampler_->set_state(static_cast<uint64_t>(number_from(archive, "random").item<int64_t>()));
  });
  step_ = progress.step;
  samples_ = progress.samples;
  seconds_before_ = seconds_ = progress.seconds;
  log::info("resumed " + path + " at step " + std::to_string(step_));
}

void DeformationTrainer::save_checkpoint() {
  torch::serialize::OutputArchive archive;
  put_training(archive, *net_, *average_, *optimizer_, {step_, samples_, seconds_});
  archive.write("random", torch::tensor(static_cast<int64_t>(sampler_->state()), torch::kLong));
  save_archive(archive, checkpoint_path(options_));
  nn::WeightsHeader header{"deformation",
                           nn::kDeformationVersion,
                           {{"samples", samples_}, {"steps", step_}, {"seconds", seconds_}}};
  nn::save_weights(options_.out, header, *average_);
}

double DeformationTrainer::done_share() const {
  const double by_time = options_.minutes > 0 ? seconds_ / (60 * options_.minutes) : 0;
  const double by_samples = options_.samples > 0 ? samples_ / static_cast<double>(options_.samples) : 0;
  return std::max(by_time, by_samples);
}

double DeformationTrainer::learning_rate() const {
  const double warm = std::min(1.0, (step_ + 1) / static_cast<double>(kWarmUpSteps));
  return kLearningRate * warm * (0.005 + 0.995 * 0.5 * (1 + std::cos(kPi * std::min(1.0, done_share()))));
}

DeformationBatch DeformationTrainer::next_batch() {
  DeformationBatch b = sampler_->next();
  for (torch::Tensor* t : {&b.points, &b.seen_joints, &b.surface, &b.weights, &b.basis, &b.canonical,
                           &b.has_canonical, &b.features, &b.transforms})
    *t = t->to(device_);
  return b;
}

void DeformationTrainer::train_step() {
  const DeformationBatch batch = next_batch();
  optimizer_->zero_grad();
  const DeformationLoss loss = deformation_loss(net_, batch);
  loss.total.backward();
  for (auto& group : optimizer_->param_groups())
    static_cast<torch::optim::AdamOptions&>(group.options()).lr(learning_rate());
  const double norm = torch::nn::utils::clip_grad_norm_(parameters_, /*max_norm=*/10.0);
  if (std::isfinite(norm)) optimizer_->step();
  update_average();
  ++step_;
  samples_ += batch.points.size(0) * batch.points.size(1);
  seconds_ = seconds_before_ + std::chrono::duration<double>(Clock::now() - started_).count();
  sum_.geometry_mm += loss.geometry_mm, sum_.edge_mm += loss.edge_mm, sum_.weight_kl += loss.weight_kl;
  sum_.offset_mm += loss.offset_mm, sum_.canonical_mm += loss.canonical_mm;
  ++sum_count_;
}

void DeformationTrainer::update_average() {
  const torch::NoGradGuard no_grad;
  const double decay = std::min(kAverageDecay, (1.0 + step_) / (10.0 + step_));
  auto averaged = average_->parameters();
  for (size_t i = 0; i < averaged.size(); ++i) averaged[i].lerp_(parameters_[i].cpu(), 1 - decay);
}

void DeformationTrainer::report() {
  const DeformationScore dev = evaluator_.score(average_);
  const double n = std::max(1, sum_count_);
  char line[300];
  std::snprintf(line, sizeof line, "%.1f,%lld,%lld,%.6f,%.3f,%.3f,%.4f,%.3f,%.2f,%.3f,%.3f,%.3f,%.3f,%.3f",
                seconds_ / 60, static_cast<long long>(step_), static_cast<long long>(samples_),
                learning_rate(), sum_.geometry_mm / n, sum_.edge_mm / n, sum_.weight_kl / n,
                sum_.offset_mm / n, sum_.canonical_mm / n, dev.mpvd_mm, dev.medl_mm, dev.noisy_mpvd_mm,
                dev.clothed_mpvd_mm, dev.clothed_medl_mm);
  sum_ = {};
  sum_count_ = 0;
  const std::string curve = options_.curve.empty() ? options_.out + ".csv" : options_.curve;
  const bool fresh = !fs::exists(curve);
  std::ofstream out(curve, std::ios::app);
  if (fresh)
    out << "minutes,step,samples,rate,geometry_mm,edge_mm,weight_kl,offset_mm,canonical_mm,dev_mpvd_mm,dev_"
           "medl_mm,"
           "dev_noisy_mpvd_mm,clothed_mpvd_mm,clothed_medl_mm\n";
  out << line << "\n";
  log::info(std::string("deformation ") + line);
}

int DeformationTrainer::run() {
  double last_checkpoint = seconds_, last_report = seconds_;
  const auto cancelled = [this] { return options_.cancelled && options_.cancelled(); };
  while (done_share() < 1 && !cancelled()) {
    train_step();
    if (step_ == 100 || seconds_ - last_report >= kSecondsPerReport) {
      report();
      last_report = seconds_;
    }
    if (seconds_ - last_checkpoint >= kSecondsPerCheckpoint) {
      save_checkpoint();
      last_checkpoint = seconds_;
    }
  }
  save_checkpoint();
  report();
  return done_share() < 1 ? 1 : 0;
}

}  // namespace

int train_deformation(const nn::TrainOptions& options) {
  return DeformationTrainer(options).run();
}

}  // namespace understudy::training
