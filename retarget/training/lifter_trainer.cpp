#include "retarget/nn/modules/lifter_net.hpp"
#include "retarget/training/lift_data.hpp"
#include "retarget/training/lift_step.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kLiftBatch = 64, kLiftFigureCases = 60;
constexpr int64_t kUsualSequences = 1300000;  // about 22 core-minutes

Schedule lifter_schedule() {
  Schedule schedule;
  schedule.rate = 2e-3;
  schedule.warm_up = 200;
  schedule.average_decay = 0.995;
  schedule.row_seconds = 180;
  return schedule;
}

class LifterTrainer final : public TrainingRun {
 public:
  explicit LifterTrainer(const nn::LifterTrainOptions& options)
      : TrainingRun(options, options.kNetwork, lifter_schedule()),
        options_(options),
        rng_(options.seed),
        data_(load_training_data(options.data, Split::Train), options.frames),
        figures_(load_training_data(options.data, Split::Dev), kLiftFigureCases, options.frames) {
    net_->to(device());
    average_->to(device());
    average_->eval();
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                              torch::optim::AdamWOptions(1e-3).weight_decay(1e-4)));
  }

 private:
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kLiftBatch;
    const LossSum loss = lift_loss(net_, data_.batch(count, rng_), device());
    loss.total.backward();
    return {count, loss.parts};
  }
  Figures evaluate() override { return figures_.of(average_, device()); }
  nn::WeightsHeader header() const override { return {"lifter", nn::kLifterVersion, {}}; }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::LifterTrainOptions options_;
  Rng rng_;
  LiftData data_;
  LiftFigures figures_;
  nn::LifterNet net_, average_;
};

}  // namespace

int train(const nn::LifterTrainOptions& options) {
  return LifterTrainer(with_end(options, kUsualSequences)).run();
}

}  // namespace understudy::training
