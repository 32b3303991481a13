#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/training/losses/motion_losses.hpp"
#include "retarget/training/motion_evaluator.hpp"
#include "retarget/training/motion_step.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr float kDevNoise = 0.02f;  // metres

Schedule motion_schedule() {
  Schedule schedule;
  schedule.most_gradient = 0.1;
  return schedule;
}

nn::MotionGruOptions form_of(const nn::MotionTrainOptions& options) {
  nn::MotionGruOptions form;
  form.quaternions = options.rotation == "quaternion";
  return form;
}

MotionBatch to_device(MotionBatch batch, const torch::Device& device) {
  for (auto* tensor : {&batch.joints, &batch.leg, &batch.dt, &batch.clean, &batch.rotations, &batch.rest_a,
                       &batch.rest_b, &batch.seen_b, &batch.real})
    *tensor = tensor->to(device);
  return batch;
}

class MotionTrainer final : public TrainingRun {
 public:
  explicit MotionTrainer(const nn::MotionTrainOptions& options);

 private:
  double learn_to_discriminate(const MotionBatch& batch, const torch::Tensor& made);

  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override;
  void put_own(torch::serialize::OutputArchive& archive) const override;
  void take_own(torch::serialize::InputArchive& archive) override;

  nn::MotionGruOptions form_;
  MotionBatchOptions batch_;
  MotionLossWeights weights_;
  Rng rng_;
  MotionData data_;
  MotionEvaluator clean_, noisy_;
  nn::MotionGru net_;
  MotionDiscriminator discriminator_;
  nn::MotionGru average_;
  std::unique_ptr<torch::optim::Adam> discriminator_optimizer_;
};

MotionTrainer::MotionTrainer(const nn::MotionTrainOptions& options)
    : TrainingRun(options, options.kNetwork, motion_schedule()),
      form_(form_of(options)),
      rng_(options.seed),
      data_(load_training_data(options.data, Split::Train)),
      clean_(load_training_data(options.data, Split::Dev), 0),
      noisy_(load_training_data(options.data, Split::Dev), kDevNoise),
      net_(form_),
      average_(form_) {
  if (options.batch > 0) batch_.size = options.batch;
  batch_.frames = options.context;
  if (!options.rotation_loss) weights_.rotation = 0;
  net_->to(device());
  discriminator_->to(device());
  own(net_.ptr(), average_.ptr(), std::make_unique<torch::optim::Adam>(net_->parameters()));
  discriminator_optimizer_ = std::make_unique<torch::optim::Adam>(
      discriminator_->parameters(), torch::optim::AdamOptions(2e-4).betas({0.5, 0.99}));
  log::info(detail::join("motion: ", data_.stretches(), " stretches of motion, each on its own body"));
}

TrainingRun::Step MotionTrainer::learn() {
  const MotionBatch batch = to_device(data_.batch(batch_, rng_), device());
  MotionStep step = motion_step(net_, discriminator_, batch, weights_);
  step.loss.total.backward();
  if (batch.crossed > 0 && all_finite(step.loss.parts))
    step.loss.parts.push_back({"discriminator_accuracy", learn_to_discriminate(batch, step.made)});
  return {batch.joints.size(0), step.loss.parts};
}

/// The discriminator's step, and its accuracy before it.
double MotionTrainer::learn_to_discriminate(const MotionBatch& batch, const torch::Tensor& made) {
  const auto rest = batch.rest_b.slice(0, 0, batch.crossed), dt = batch.dt.slice(0, 0, batch.crossed);
  const auto real_scores = discriminator_->forward(batch.real, rest, dt);
  const auto made_scores = discriminator_->forward(made, rest, dt);
  discriminator_optimizer_->zero_grad();
  discriminator_loss(real_scores, made_scores).backward();
  discriminator_optimizer_->step();
  return discriminator_accuracy(real_scores, made_scores);
}

Figures MotionTrainer::evaluate() {
  Figures figures = clean_.evaluate(average_, "dev_");
  for (const Figure& figure : noisy_.evaluate(average_, "dev_noisy_")) figures.push_back(figure);
  return figures;
}

nn::WeightsHeader MotionTrainer::header() const {
  return {"motion",
          nn::kMotionGruVersion,
          {{"hidden", static_cast<double>(form_.hidden)},
           {"layers", static_cast<double>(form_.layers)},
           {"quaternions", form_.quaternions ? 1.0 : 0.0}}};
}

void MotionTrainer::put_own(torch::serialize::OutputArchive& archive) const {
  put(archive, "discriminator", *discriminator_);
  put(archive, "discriminator_optimizer", *discriminator_optimizer_);
  put_random(archive, rng_.state());
}

void MotionTrainer::take_own(torch::serialize::InputArchive& archive) {
  take(archive, "discriminator", *discriminator_);
  take(archive, "discriminator_optimizer", *discriminator_optimizer_);
  rng_ = Rng(take_random(archive));
}

}  // namespace

int train(const nn::MotionTrainOptions& options) {
  return MotionTrainer(options).run();
}

}  // namespace understudy::training
