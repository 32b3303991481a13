#include <array>

#include "retarget/training/dynamics_step.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kDynamicsBatch = 48, kDynamicsFigureCases = 96;
constexpr int kGoesOnFrames = 31;                          // of sequences without keys
constexpr std::array<int, 3> kKeyedFrames = {31, 46, 61};  // of those with keys
constexpr float kKeyedShare = 0.67f;                       // of the batches
constexpr int64_t kUsualMotions = 120000;

Schedule dynamics_schedule() {
  Schedule schedule;
  schedule.rate = 1e-3;
  schedule.warm_up = 100;
  schedule.average_decay = 0.995;
  schedule.row_seconds = 120;
  return schedule;
}

class DynamicsTrainer final : public TrainingRun {
 public:
  explicit DynamicsTrainer(const nn::MarionetteDynamicsTrainOptions& options)
      : TrainingRun(options, options.kNetwork, dynamics_schedule()),
        options_(options),
        rng_(options.seed),
        data_(options.kind, options.data, Split::Train),
        net_(form(options, data_)),
        average_(form(options, data_)) {
    Rng figures(1);
    DynamicsData dev(options.kind, options.data, Split::Dev);
    dev_between_ = placed(dev.batch(kDynamicsFigureCases, kKeyedFrames.back(), Known::Keys, figures));
    dev_ahead_ = placed(dev.batch(kDynamicsFigureCases, kGoesOnFrames, Known::Beginning, figures));
    net_->to(device());
    average_->to(device());
    average_->eval();
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                              torch::optim::AdamWOptions(1e-3).weight_decay(1e-4)));
  }

 private:
  static nn::VrnnOptions form(const nn::MarionetteDynamicsTrainOptions& options, const DynamicsData& data) {
    nn::VrnnOptions form;
    form.joints = static_cast<int64_t>(data.parents().size());
    form.positions = options.form == "positions";
    return form;
  }
  DynamicsBatch placed(const DynamicsBatch& batch) const {
    return {batch.rows.to(device()), batch.dt.to(device()), batch.rest.to(device()), batch.known};
  }
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kDynamicsBatch;
    const bool keyed = rng_.uniform(0, 1) < kKeyedShare;
    const int frames =
        keyed ? kKeyedFrames[static_cast<size_t>(rng_.below(static_cast<int>(kKeyedFrames.size())))]
              : kGoesOnFrames;
    const LossSum loss =
        dynamics_loss(net_, placed(data_.batch(count, frames, keyed ? Known::Keys : Known::Beginning, rng_)),
                      data_.parents());
    loss.total.backward();
    return {count, loss.parts};
  }
  Figures evaluate() override {
    Figures figures = between_figures(average_, dev_between_, data_.parents());
    const Figures ahead = ahead_figures(average_, dev_ahead_, data_.parents());
    figures.insert(figures.end(), ahead.begin(), ahead.end());
    return figures;
  }
  nn::WeightsHeader header() const override {
    return {nn::kDynamicsWeights,
            nn::kDynamicsVersion,
            {{"joints", static_cast<double>(net_->options().joints)},
             {"positions", net_->options().positions ? 1.0 : 0.0}},
            {{"kind", options_.kind}, {"bones", data_.bones()}}};
  }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::MarionetteDynamicsTrainOptions options_;
  Rng rng_;
  DynamicsData data_;
  DynamicsBatch dev_between_, dev_ahead_;
  nn::RotationVrnn net_, average_;
};

}  // namespace

int train(const nn::MarionetteDynamicsTrainOptions& options) {
  return DynamicsTrainer(with_end(options, kUsualMotions)).run();
}

}  // namespace understudy::training
