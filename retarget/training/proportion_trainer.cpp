#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/nn/modules/proportion_net.hpp"
#include "retarget/pose2d/proportion_input.hpp"
#include "retarget/training/proportion_data.hpp"
#include "retarget/training/proportion_figures.hpp"
#include "retarget/training/proportion_step.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kProportionBatch = 512, kFigureCases = 600;
constexpr int64_t kUsualPoses = 22000000;  // about 12 core-minutes

Schedule proportion_schedule() {
  Schedule schedule;
  schedule.rate = 1.5e-3;
  schedule.warm_up = 100;
  schedule.average_decay = 0.998;
  return schedule;
}

class ProportionTrainer final : public TrainingRun {
 public:
  explicit ProportionTrainer(const nn::ProportionsTrainOptions& options)
      : TrainingRun(options, options.kNetwork, proportion_schedule()),
        options_(options),
        rng_(options.seed),
        data_(load_training_data(options.data, Split::Train)),
        figures_(load_training_data(options.data, Split::Dev), kFigureCases) {
    net_->to(device());
    average_->to(device());
    average_->eval();
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                              torch::optim::AdamWOptions(1e-3).weight_decay(1e-4)));
    std::string line = "proportions: oks on people and motions held back:";
    for (const Figure& figure : figures_.baselines())
      line += printed(" %s %.1f", figure.name.c_str(), figure.value);
    log::info(line);
  }

 private:
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kProportionBatch;
    const LossSum loss = proportion_loss(net_, data_.batch(count, rng_), device());
    loss.total.backward();
    return {count, loss.parts};
  }
  Figures evaluate() override {
    return figures_.of([this](const std::vector<FlatPose>& poses) { return read_lengths(average_, poses); });
  }
  nn::WeightsHeader header() const override { return {"proportions", nn::kProportionVersion, {}}; }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::ProportionsTrainOptions options_;
  Rng rng_;
  ProportionData data_;
  ProportionFigures figures_;
  nn::ProportionNet net_, average_;
};

}  // namespace

int train(const nn::ProportionsTrainOptions& options) {
  return ProportionTrainer(with_end(options, kUsualPoses)).run();
}

}  // namespace understudy::training
