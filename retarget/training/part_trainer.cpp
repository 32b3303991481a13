#include <algorithm>
#include <future>

#include "retarget/base/text.hpp"
#include "retarget/nn/modules/part_refiner.hpp"
#include "retarget/training/losses/skeleton_losses.hpp"
#include "retarget/training/part_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kScansAStep = 24, kDevPartScans = 120;
static_assert(nn::kPartKindNames.size() == nn::kPartKinds);

PartKinds kinds_of(const std::vector<std::string>& names) {
  PartKinds kinds;
  for (size_t k = 0; k < kinds.size(); ++k)
    kinds[k] = names.empty() || std::find(names.begin(), names.end(), nn::kPartKindNames[k]) != names.end();
  return kinds;
}

Schedule part_schedule() {
  Schedule schedule;
  schedule.warm_up = 200;
  schedule.average_decay = 0.998;
  schedule.first_row = 20;
  return schedule;
}

class PartTrainer final : public TrainingRun {
 public:
  explicit PartTrainer(const nn::PartTrainOptions& options)
      : TrainingRun(options, options.kNetwork, part_schedule()),
        scans_(options.batch > 0 ? options.batch : kScansAStep),
        seed_(options.seed),
        kinds_(kinds_of(options.kinds)),
        train_(load_training_data(options.data, Split::Train)),
        dev_(PartSampler(load_training_data(options.data, Split::Dev), kinds_, 12345).next(kDevPartScans)) {
    net_->to(device());
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                              torch::optim::AdamWOptions().weight_decay(1e-4)));
  }

 private:
  PartBatches next_batches();
  Step learn() override;
  Figures evaluate() override;
  /// Kinds that are trained may be of another form there.
  bool may_lack(const std::string& tensor) const override {
    for (size_t k = 0; k < kinds_.size(); ++k)
      if (kinds_[k] && starts_with(tensor, std::string(nn::kPartNames[k]) + '.')) return true;
    return false;
  }
  nn::WeightsHeader header() const override { return {nn::kPartFileKind, nn::kPartVersion, {}}; }

  int scans_;
  uint64_t seed_;
  PartKinds kinds_;
  TrainingData train_;
  PartBatches dev_;
  nn::PartRefinerNet net_, average_;
  std::unique_ptr<PartSampler> sampler_;
  std::future<PartBatches> coming_;  // the next scans are made while the network learns from these
};

PartBatches PartTrainer::next_batches() {
  const auto make = [this] { return sampler_->next(scans_); };
  if (!sampler_) {  // a resumed run makes other scans than those that were seen before
    sampler_ =
        std::make_unique<PartSampler>(train_, kinds_, seed_ + static_cast<uint64_t>(progress().step) * 7919);
    coming_ = std::async(std::launch::async, make);
  }
  PartBatches batches = coming_.get();
  coming_ = std::async(std::launch::async, make);
  return batches;
}

TrainingRun::Step PartTrainer::learn() {
  const PartBatches batches = next_batches();
  auto loss = torch::zeros({});
  for (int kind = 0; kind < nn::kPartKinds; ++kind) {
    const PartBatch& batch = batches[kind];
    if (batch.points.size(0) == 0) continue;
    const auto output = net_->of(static_cast<nn::PartKind>(kind))
                            .forward(batch.points.to(device()), batch.context.to(device()));
    loss = loss + part_loss(output, batch.truth.to(device()));
  }
  loss.backward();
  return {scans_, {{"loss", loss.item<double>()}}};
}

/// Of every kind, without looking and after it: degrees of its first joint, how far off its two joints, leg
/// lengths.
Figures PartTrainer::evaluate() {
  Figures figures;
  for (size_t kind = 0; kind < nn::kPartKinds; ++kind) {
    const PartBatch& batch = dev_[kind];
    if (!kinds_[kind]) continue;
    const auto output = average_->of(static_cast<nn::PartKind>(kind)).forward(batch.points, batch.context);
    const auto add = [&](const char* what, double before, double now) {
      const std::string name = std::string(nn::kPartKindNames[kind]) + "_" + what;
      figures.push_back({name + "_before", before});
      figures.push_back({name, now});
    };
    const auto first_turn = [](const torch::Tensor& x) { return x.select(1, 0).narrow(1, 0, 6); };
    const auto truth = first_turn(batch.truth);
    add("deg", mean_angle_deg(first_turn(batch.before), truth), mean_angle_deg(first_turn(output), truth));
    const auto before = place_error(batch.before, batch.truth).mean(0),
               now = place_error(output, batch.truth).mean(0);
    add("first", before[0].item<double>(), now[0].item<double>());
    add("second", before[1].item<double>(), now[1].item<double>());
  }
  return figures;
}

}  // namespace

int train(const nn::PartTrainOptions& options) {
  return PartTrainer(options).run();
}

}  // namespace understudy::training
