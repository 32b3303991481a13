#include "retarget/training/skeleton_trainer.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/training/checkpoint_archive.hpp"
#include "retarget/training/parameters.hpp"
#include "retarget/training/scan_streams.hpp"
#include "retarget/training/skeleton_batch.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using nn::SkeletonForm;

constexpr double kLearningRate = 1e-3, kContinuedRate = 5e-4;  // the latter where weights are trained on
constexpr int kWarmUpSteps = 400;
constexpr double kAverageDecay = 0.999;
constexpr double kSecondsPerCheckpoint = 180;
constexpr int kDevScans = 192, kDevPeople = 32;
constexpr int kFollowed = 5;  // frames that a person is followed for, at most

/// Several copies of one network on as many threads. Their parameters are the same memory, their gradients
/// are their own: each thread makes and learns from its own scans, then the gradients are averaged. Scales
/// better on small tensors than threads inside each operation, and does not collapse when another process
/// wants a core.
struct Replica {
  std::shared_ptr<SkeletonForm> net;
  std::unique_ptr<ScanStreams> streams;
  SkeletonLoss loss;
  std::exception_ptr failure;
};

class SkeletonTrainer {
 public:
  explicit SkeletonTrainer(const nn::TrainOptions& options);
  int run();

 private:
  void add_replicas();
  void resume();
  void save_checkpoint();
  void train_step();
  void average_gradients();
  void update_average();
  void report();
  double done_share() const;
  double learning_rate() const;
  std::vector<SkeletonScore> evaluate();

  nn::TrainOptions options_;
  torch::Device device_;
  TrainingData train_, dev_;
  ScanMakerOptions scans_;
  std::shared_ptr<SkeletonForm> net_, average_, first_;  // first_: where some of it is kept
  std::vector<torch::Tensor> parameters_;
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  std::vector<Replica> replicas_;
  TrainingProgress progress_;
  Clock::time_point started_ = Clock::now();
  double seconds_before_ = 0, loss_sum_ = 0, vote_sum_ = 0, part_sum_ = 0, rotation_sum_ = 0;
  int loss_count_ = 0;
};

std::string checkpoint_path(const nn::TrainOptions& options) {
  return options.out + ".checkpoint";
}

SkeletonTrainer::SkeletonTrainer(const nn::TrainOptions& options)
    : options_(options),
      device_(options.device),
      train_(load_training_data(options.data, Split::Train)),
      dev_(load_training_data(options.data, Split::Dev)) {
  if (options_.batch == 0) options_.batch = 32;
  if (options_.threads == 0)
    options_.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (device_.is_cuda()) options_.threads = 1;
  US_CHECK(options_.poses == "all" || options_.poses == "rest", "--poses is all or rest, not ",
           options_.poses);
  if (options_.poses == "rest")
    scans_ = ScanMakerOptions::rest();
  else if (options_.form == "dense")  // the others look at one scan alone
    scans_.longest = kFollowed;
  US_CHECK(options_.keep == 0 || !options_.init.empty(), "--keep wants --init");
  US_CHECK(options_.minutes > 0 || options_.samples > 0, "training wants --minutes or --samples");
  torch::manual_seed(options_.seed);
  net_ = nn::make_skeleton_form(options_.form);
  average_ = nn::make_skeleton_form(options_.form);
  if (!options_.init.empty()) nn::load_skeleton_form(options_.init, options_.form, *net_);
  if (options_.keep > 0) {
    first_ = nn::make_skeleton_form(options_.form);
    copy_parameters(*net_, *first_);
  }
  net_->to(device_);
  average_->to(device_);
  copy_parameters(*net_, *average_);
  parameters_ = net_->parameters();
  optimizer_ = std::make_unique<torch::optim::AdamW>(
      parameters_, torch::optim::AdamWOptions(kLearningRate).betas({0.9, 0.98}).weight_decay(0.01));
  resume();
  add_replicas();
}

void SkeletonTrainer::add_replicas() {
  for (int i = 0; i < options_.threads; ++i) {
    Replica replica;
    replica.net = nn::make_skeleton_form(options_.form);
    replica.net->to(device_);
    auto own = replica.net->parameters();
    for (size_t p = 0; p < own.size(); ++p) own[p].set_data(parameters_[p].data());
    // A resumed run makes new scans, not the first ones again.
    const uint64_t seed = options_.seed * 1000003 + static_cast<uint64_t>(progress_.samples) * 101 + i;
    replica.streams = std::make_unique<ScanStreams>(train_, scans_, seed, std::max(128, 4 * options_.batch));
    replicas_.push_back(std::move(replica));
  }
}

void SkeletonTrainer::resume() {
  const std::string path = checkpoint_path(options_);
  if (!fs::exists(path)) return;
  read_archive(path, c10::nullopt, [&](torch::serialize::InputArchive& archive) {
    progress_ = take_training(archive, *net_, *average_, *optimizer_);
  });
  seconds_before_ = progress_.seconds;
  log::info("resumed " + path + " at " + std::to_string(progress_.samples) + " samples");
}

void SkeletonTrainer::save_checkpoint() {
  torch::serialize::OutputArchive archive;
  put_training(archive, *net_, *average_, *optimizer_, progress_);
  save_archive(archive, checkpoint_path(options_));
  const auto kept = nn::make_skeleton_form(options_.form);
  copy_parameters(*average_, *kept);
  if (options_.keep > 0) mix_parameters(*first_, *kept, options_.keep);
  nn::save_skeleton_form(options_.out, options_.form, *kept, progress_.samples);
}

double SkeletonTrainer::done_share() const {
  const double by_time = options_.minutes > 0 ? progress_.seconds / (60 * options_.minutes) : 0;
  const double by_samples =
      options_.samples > 0 ? progress_.samples / static_cast<double>(options_.samples) : 0;
  return std::max(by_time, by_samples);
}

double SkeletonTrainer::learning_rate() const {
  const double warm = std::min(1.0, (progress_.step + 1) / static_cast<double>(kWarmUpSteps));
  const double peak = options_.init.empty() ? kLearningRate : kContinuedRate;
  return peak * warm * (0.01 + 0.99 * 0.5 * (1 + std::cos(kPi * std::min(1.0, done_share()))));
}

void SkeletonTrainer::train_step() {
  const int share = std::max(1, options_.batch / static_cast<int>(replicas_.size()));
  const auto work = [this, share](Replica& replica) {
    try {
      at::set_num_threads(1);
      const FollowedScans followed = replica.streams->next(share);
      const SkeletonBatch batch = to_device(make_batch(followed.scans, followed.recent), device_);
      for (auto& p : replica.net->parameters())
        if (p.grad().defined()) p.mutable_grad().zero_();
      const auto out = replica.net->forward(batch.input);
      replica.streams->saw(world_joints(out, batch));
      replica.loss = skeleton_loss(out, batch.input.centres, batch.truth);
      replica.loss.total.backward();
    } catch (...) {
      replica.failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (size_t i = 1; i < replicas_.size(); ++i) threads.emplace_back(work, std::ref(replicas_[i]));
  work(replicas_[0]);
  for (auto& thread : threads) thread.join();
  for (const Replica& replica : replicas_)
    if (replica.failure) std::rethrow_exception(replica.failure);

  average_gradients();
  for (auto& group : optimizer_->param_groups())
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(learning_rate());
  const double norm = torch::nn::utils::clip_grad_norm_(parameters_, 1.0);
  if (std::isfinite(norm)) optimizer_->step();
  update_average();
  ++progress_.step;
  progress_.samples += static_cast<int64_t>(share * replicas_.size());
  progress_.seconds = seconds_before_ + std::chrono::duration<double>(Clock::now() - started_).count();
}

void SkeletonTrainer::average_gradients() {
  const torch::NoGradGuard no_grad;
  for (const Replica& replica : replicas_) {
    loss_sum_ += replica.loss.joint.item<double>() / replicas_.size();
    vote_sum_ += replica.loss.vote.item<double>() / replicas_.size();
    part_sum_ += replica.loss.part.item<double>() / replicas_.size();
    rotation_sum_ += replica.loss.rotation.item<double>() / replicas_.size();
  }
  ++loss_count_;
  std::vector<std::vector<torch::Tensor>> own;
  for (const Replica& replica : replicas_) own.push_back(replica.net->parameters());
  for (size_t p = 0; p < parameters_.size(); ++p) {
    torch::Tensor sum;
    for (const auto& of : own)
      if (of[p].grad().defined()) sum = sum.defined() ? sum + of[p].grad() : of[p].grad();
    if (sum.defined()) parameters_[p].mutable_grad() = sum / static_cast<double>(replicas_.size());
  }
}

void SkeletonTrainer::update_average() {
  const torch::NoGradGuard no_grad;
  const double decay = std::min(kAverageDecay, (1.0 + progress_.step) / (10.0 + progress_.step));
  auto averaged = average_->parameters();
  for (size_t i = 0; i < averaged.size(); ++i) averaged[i].lerp_(parameters_[i], 1 - decay);
}

/// Unseen people in unseen motions: clean and captured scans.
std::vector<SkeletonScore> SkeletonTrainer::evaluate() {
  const torch::NoGradGuard no_grad;
  std::vector<SkeletonScore> scores;
  for (const float captured : {0.0f, 1.0f}) {
    ScanMakerOptions plain = scans_;
    plain.mixed = plain.jittered = plain.tilted = plain.stretch = 0;
    if (options_.poses == "all") plain.t_pose = 0;
    plain.mirror = false;
    plain.captured = captured;
    plain.dressed = captured;
    ScanStreams streams(dev_, plain, 77, kDevPeople);
    SkeletonScore mean;
    for (int i = 0; i < kDevScans / kDevPeople; ++i) {
      const FollowedScans followed = streams.next(kDevPeople);
      const SkeletonBatch batch = to_device(make_batch(followed.scans, followed.recent), device_);
      const auto out = average_->forward(batch.input);
      streams.saw(world_joints(out, batch));
      const SkeletonScore s = score(out, batch);
      const double w = static_cast<double>(kDevPeople) / kDevScans;
      mean.joint_mm += w * s.joint_mm, mean.swap_rate += w * s.swap_rate,
          mean.rotation_deg += w * s.rotation_deg;
    }
    scores.push_back(mean);
  }
  return scores;
}

void SkeletonTrainer::report() {
  const auto scores = evaluate();
  const double n = std::max(1, loss_count_);
  char line[400];
  std::snprintf(line, sizeof line, "%.1f,%lld,%lld,%.5f,%.4f,%.4f,%.4f,%.4f,%.1f,%.3f,%.2f,%.1f,%.3f,%.2f",
                progress_.seconds / 60, static_cast<long long>(progress_.step),
                static_cast<long long>(progress_.samples), learning_rate(), loss_sum_ / n, vote_sum_ / n,
                part_sum_ / n, rotation_sum_ / n, scores[0].joint_mm, scores[0].swap_rate,
                scores[0].rotation_deg, scores[1].joint_mm, scores[1].swap_rate, scores[1].rotation_deg);
  loss_sum_ = vote_sum_ = part_sum_ = rotation_sum_ = 0;
  loss_count_ = 0;
  const std::string curve = options_.curve.empty() ? options_.out + ".csv" : options_.curve;
  const bool fresh = !fs::exists(curve);
  std::ofstream out(curve, std::ios::app);
  if (fresh)
    out << "minutes,step,samples,rate,joint_loss,vote_loss,part_loss,rotation_loss,dev_mm,dev_swap,dev_deg,"
           "captured_mm,"
           "captured_swap,captured_deg\n";
  out << line << "\n";
  log::info(std::string("skeleton ") + line);
}

int SkeletonTrainer::run() {
  double last_checkpoint = progress_.seconds;
  const auto cancelled = [this] { return options_.cancelled && options_.cancelled(); };
  while (done_share() < 1 && !cancelled()) {
    train_step();
    if (progress_.step == 200 || progress_.seconds - last_checkpoint >= kSecondsPerCheckpoint) {
      save_checkpoint();
      report();
      last_checkpoint = progress_.seconds;
    }
  }
  save_checkpoint();
  report();
  return done_share() < 1 ? 1 : 0;
}

}  // namespace

int train_skeleton(const nn::TrainOptions& options) {
  return SkeletonTrainer(options).run();
}

}  // namespace understudy::training
