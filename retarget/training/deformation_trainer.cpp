#include "retarget/training/deformation_step.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

Schedule deformation_schedule() {
  Schedule schedule;
  schedule.rate = 2e-3;
  schedule.last_rate = 0.005;
  schedule.warm_up = 200;
  schedule.most_gradient = 10;
  schedule.average_decay = 0.998;
  schedule.row_seconds = 300;
  return schedule;
}

DeformationDataOptions data_options(const nn::TrainOptions& options) {
  DeformationDataOptions data;
  if (options.batch > 0) data.bodies = options.batch;
  return data;
}

DeformationBatch to_device(DeformationBatch batch, const torch::Device& device) {
  for (auto* tensor : {&batch.points, &batch.seen_joints, &batch.surface, &batch.weights, &batch.basis,
                       &batch.canonical, &batch.has_canonical, &batch.features, &batch.transforms})
    *tensor = tensor->to(device);
  return batch;
}

class DeformationTrainer final : public TrainingRun {
 public:
  explicit DeformationTrainer(const nn::DeformationTrainOptions& options)
      : TrainingRun(options, options.kNetwork, deformation_schedule()),
        train_(load_training_data(options.data, Split::Train)),
        evaluator_(load_training_data(options.data, Split::Dev)),
        sampler_(train_, data_options(options), options.seed) {
    net_->to(device());
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::Adam>(net_->parameters(),
                                             torch::optim::AdamOptions().betas({0.9, 0.98})));
  }

 private:
  Step learn() override {
    const DeformationBatch batch = to_device(sampler_.next(), device());
    const LossSum loss = deformation_loss(net_, batch);
    loss.total.backward();
    return {batch.points.size(0) * batch.points.size(1), loss.parts};
  }
  Figures evaluate() override { return evaluator_.evaluate(average_); }
  nn::WeightsHeader header() const override { return {"deformation", nn::kDeformationVersion, {}}; }
  void put_own(torch::serialize::OutputArchive& archive) const override {
    put_random(archive, sampler_.state());
  }
  void take_own(torch::serialize::InputArchive& archive) override {
    sampler_.set_state(take_random(archive));
  }

  TrainingData train_;
  DeformationEvaluator evaluator_;
  DeformationSampler sampler_;
  nn::DeformationNet net_, average_;
};

}  // namespace

int train(const nn::DeformationTrainOptions& options) {
  return DeformationTrainer(options).run();
}

}  // namespace understudy::training
