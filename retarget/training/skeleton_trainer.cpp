#include <algorithm>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/training/scan_streams.hpp"
#include "retarget/training/skeleton_batch.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

using nn::SkeletonForm;

constexpr double kLearningRate = 1e-3, kContinuedRate = 5e-4;  // the latter where weights are trained on
constexpr int kBatch = 32, kDevScans = 192, kDevHalves = 128, kDevPeople = 32;
constexpr int kFollowed = 5;  // frames that a person is followed for, at most

/// Several copies of one network on as many threads. Their parameters are the same memory, their gradients
/// are their own: each thread makes and learns from its own scans, then the gradients are averaged. Scales
/// better on small tensors than threads inside each operation, and does not collapse when another process
/// needs a core.
struct Replica {
  std::shared_ptr<SkeletonForm> net;
  std::unique_ptr<ScanStreams> streams;
  Figures losses;
  std::exception_ptr failure;
};

Schedule skeleton_schedule(const nn::SkeletonTrainOptions& options) {
  Schedule schedule;
  schedule.rate = options.init.empty() ? kLearningRate : kContinuedRate;
  schedule.warm_up = 400;
  schedule.average_decay = 0.999;
  schedule.first_row = 200;
  schedule.row_seconds = 180;
  return schedule;
}

ScanMakerOptions scan_options(const nn::SkeletonTrainOptions& options) {
  US_CHECK(options.poses == "all" || options.poses == "rest", "--poses is all or rest, not ", options.poses);
  if (options.poses == "rest") return ScanMakerOptions::rest();
  ScanMakerOptions scans;
  if (options.form == "dense") scans.longest = kFollowed;  // the other looks at one scan alone
  return scans;
}

class SkeletonTrainer final : public TrainingRun {
 public:
  explicit SkeletonTrainer(const nn::SkeletonTrainOptions& options);

 private:
  void add_replicas();
  void learn(Replica& replica, int scans);
  void average_gradients();
  ScanMakerOptions plain(float captured) const;
  Figures evaluate(const std::string& name, const ScanMakerOptions& scans, bool all_joints);

  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override { return nn::skeleton_header(options_.form); }
  bool may_lack(const std::string& tensor) const override { return starts_with(tensor, nn::kVisibilityHead); }

  nn::SkeletonTrainOptions options_;
  TrainingData train_, dev_;
  ScanMakerOptions scans_;
  std::shared_ptr<SkeletonForm> net_, average_;
  std::vector<Replica> replicas_;
};

SkeletonTrainer::SkeletonTrainer(const nn::SkeletonTrainOptions& options)
    : TrainingRun(options, options.kNetwork, skeleton_schedule(options)),
      options_(options),
      train_(load_training_data(options.data, Split::Train)),
      dev_(load_training_data(options.data, Split::Dev)),
      scans_(scan_options(options)),
      net_(nn::make_skeleton_form(options.form)),
      average_(nn::make_skeleton_form(options.form)) {
  if (options_.batch == 0) options_.batch = kBatch;
  if (options_.threads == 0)
    options_.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (device().is_cuda()) options_.threads = 1;
  net_->to(device());
  average_->to(device());
  own(net_, average_,
      std::make_unique<torch::optim::AdamW>(
          net_->parameters(),
          torch::optim::AdamWOptions(kLearningRate).betas({0.9, 0.98}).weight_decay(0.01)));
}

void SkeletonTrainer::add_replicas() {
  const auto parameters = net_->parameters();
  for (int i = 0; i < options_.threads; ++i) {
    Replica replica;
    replica.net = nn::make_skeleton_form(options_.form);
    replica.net->to(device());
    auto own = replica.net->parameters();
    for (size_t p = 0; p < own.size(); ++p) own[p].set_data(parameters[p].data());
    // A resumed run makes new scans, not the first ones again.
    const uint64_t seed = options_.seed * 1000003 + static_cast<uint64_t>(progress().samples) * 101 + i;
    replica.streams = std::make_unique<ScanStreams>(train_, scans_, seed, std::max(128, 4 * options_.batch));
    replicas_.push_back(std::move(replica));
  }
}

void SkeletonTrainer::learn(Replica& replica, int scans) {
  at::set_num_threads(1);
  const FollowedScans followed = replica.streams->next(scans);
  const SkeletonBatch batch = to_device(make_batch(followed.scans, followed.recent), device());
  replica.net->zero_grad();
  const auto out = replica.net->forward(batch.input);
  replica.streams->saw(world_joints(out, batch));
  const LossSum loss = skeleton_loss(out, batch);
  loss.total.backward();
  replica.losses = loss.parts;
}

TrainingRun::Step SkeletonTrainer::learn() {
  if (replicas_.empty()) add_replicas();
  const int share = std::max(1, options_.batch / static_cast<int>(replicas_.size()));
  const auto work = [this, share](Replica& replica) {
    try {
      learn(replica, share);
    } catch (...) {
      replica.failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (size_t i = 1; i < replicas_.size(); ++i) threads.emplace_back(work, std::ref(replicas_[i]));
  work(replicas_[0]);
  for (auto& thread : threads) thread.join();
  RunningMean losses;
  for (const Replica& replica : replicas_) {
    if (replica.failure) std::rethrow_exception(replica.failure);
    losses.add(replica.losses);
  }
  average_gradients();
  return {static_cast<int64_t>(share * replicas_.size()), losses.mean()};
}

void SkeletonTrainer::average_gradients() {
  const torch::NoGradGuard no_grad;
  std::vector<std::vector<torch::Tensor>> own;
  for (const Replica& replica : replicas_) own.push_back(replica.net->parameters());
  auto parameters = net_->parameters();
  for (size_t p = 0; p < parameters.size(); ++p) {
    torch::Tensor sum;
    for (const auto& of : own)
      if (of[p].grad().defined()) sum = sum.defined() ? sum + of[p].grad() : of[p].grad();
    if (sum.defined()) parameters[p].mutable_grad() = sum / static_cast<double>(replicas_.size());
  }
}

/// Of scans that are evaluated on: people of the dev split as they move.
ScanMakerOptions SkeletonTrainer::plain(float captured) const {
  ScanMakerOptions plain = scans_.whole_and_alone();
  plain.mixed = plain.jittered = plain.tilted = plain.stretch = 0;
  if (options_.poses == "all") plain.t_pose = 0;
  plain.mirror = false;
  plain.captured = plain.dressed = captured;
  return plain;
}

/// What is gathered over scans that are evaluated on.
struct DevSums {
  JointSequence found, truth;
  double turned_deg = 0, seen_mm = 0, seen = 0, right = 0;

  void add(const nn::ExtractorOutput& out, const SkeletonBatch& batch, const std::vector<Joints>& joints,
           const std::vector<MadeScan>& scans);
};

void DevSums::add(const nn::ExtractorOutput& out, const SkeletonBatch& batch,
                  const std::vector<Joints>& joints, const std::vector<MadeScan>& scans) {
  found.insert(found.end(), joints.begin(), joints.end());
  for (size_t i = 0; i < scans.size(); ++i) {
    truth.push_back(scans[i].truth.joints);
    const PerJoint error = (joints[i] - truth.back()).rowwise().norm().array();
    seen_mm += 1000.0 * (error * scans[i].sight.seen).sum();
    seen += scans[i].sight.seen.sum();
  }
  if (out.rotations.defined()) turned_deg += mean_angle_deg(out.rotations, batch.truth.rotations);
  if (out.visibility.defined())
    right += ((out.visibility > 0) == (batch.truth.seen > 0)).to(torch::kFloat32).mean().item<double>();
}

/// Of whole bodies all joints, of others those that are seen.
Figures SkeletonTrainer::evaluate(const std::string& name, const ScanMakerOptions& scans, bool all_joints) {
  ScanStreams streams(dev_, scans, 77, kDevPeople);
  DevSums sums;
  const int batches = (all_joints ? kDevScans : kDevHalves) / kDevPeople;
  for (int i = 0; i < batches; ++i) {
    const FollowedScans followed = streams.next(kDevPeople);
    const SkeletonBatch batch = to_device(make_batch(followed.scans, followed.recent), device());
    const auto out = average_->forward(batch.input);
    const auto joints = world_joints(out, batch);
    streams.saw(joints);
    sums.add(out, batch, joints, followed.scans);
  }
  if (!all_joints)
    return {{name + "_mm", sums.seen_mm / std::max(1.0, sums.seen)}, {name + "_seen", sums.right / batches}};
  return {{name + "_mm", 1000 * mean_joint_error(sums.found, sums.truth)},
          {name + "_swap", swap_rate(sums.found, sums.truth)},
          {name + "_deg", sums.turned_deg / batches}};
}

/// Unseen people in unseen motions: clean and captured scans; half bodies, and scans of depth cameras with
/// things about.
Figures SkeletonTrainer::evaluate() {
  Figures figures = evaluate("dev", plain(0), true);
  const auto add = [&](const Figures& more) { figures.insert(figures.end(), more.begin(), more.end()); };
  add(evaluate("captured", plain(1), true));
  if (options_.poses == "rest") return figures;
  ScanMakerOptions half = plain(0.5f), sensed = plain(1);
  half.cut_below = 0.6f, half.cut_beside = half.desks = half.seated = 0.2f;
  sensed.sensors = 1, sensed.ground = 0.5f, sensed.furniture = sensed.others = 0.2f;
  add(evaluate("partial", half, false));
  add(evaluate("sensors", sensed, false));
  return figures;
}

}  // namespace

int train(const nn::SkeletonTrainOptions& options) {
  return SkeletonTrainer(options).run();
}

}  // namespace understudy::training
