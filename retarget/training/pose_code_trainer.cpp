#include "retarget/base/error.hpp"
#include "retarget/nn/modules/pose_code_net.hpp"
#include "retarget/training/losses/pose_code_losses.hpp"
#include "retarget/training/pose_code_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kPosePairs = 64, kPoseCodeCases = 500;  // of a step, as in the paper; of a row of the curve
constexpr double kSamePose = 0.5, kLinks = 300, kAngles = 2;  // section 3.3

/// Section 4: RMSProp at 1e-4, averaged with a weight of 1e-4. The rate falls along a cosine, as all
/// trainings' here.
Schedule pose_code_schedule() {
  Schedule schedule;
  schedule.rate = 1e-4;
  schedule.last_rate = 0.1;
  schedule.most_gradient = 100;
  schedule.average_decay = 0.9999;
  return schedule;
}

torch::optim::RMSpropOptions rmsprop() {
  return torch::optim::RMSpropOptions(1e-4);
}

LinkPairs pairs_called(const std::string& name) {
  return name == "bones" ? LinkPairs::Bones : name == "ends" ? LinkPairs::BonesAndEnds : LinkPairs::All;
}

class PoseCodeTrainer final : public TrainingRun {
 public:
  explicit PoseCodeTrainer(const nn::Pose2dTrainOptions& options)
      : TrainingRun(options, options.kNetwork, pose_code_schedule()),
        options_(options),
        rng_(options.seed),
        data_(load_training_data(options.data, Split::Train), options.seed),
        figures_(load_training_data(options.data, Split::Dev), kPoseCodeCases),
        judge_(PoseCodeData::kPeople),
        pairs_(link_pairs(pairs_called(options.pairs))),
        directions_(link_directions(options.directions, options.first_direction)) {
    US_CHECK(device().is_cpu(), "2D poses are learned on the CPU");
    average_->eval();
    own(net_.ptr(), average_.ptr(), std::make_unique<torch::optim::RMSprop>(net_->parameters(), rmsprop()));
    judging_ = std::make_unique<torch::optim::RMSprop>(judge_->parameters(), rmsprop());
  }

 private:
  /// The score of each pose as the person it should be.
  static torch::Tensor scores_of(const torch::Tensor& scores, const PoseCodeBatch& batch) {
    return scores.gather(1, batch.person.unsqueeze(1)).squeeze(1);
  }
  LossSum generator(const PoseCodeBatch& batch, const torch::Tensor& made);
  Figures discriminator(const PoseCodeBatch& batch, const torch::Tensor& made);

  Step learn() override {
    const PoseCodeBatch batch = data_.batch(options_.batch > 0 ? options_.batch : kPosePairs, rng_);
    const auto made = net_(batch.poses, batch.people);
    LossSum loss = generator(batch, made);
    loss.total.backward();
    if (all_finite(loss.parts))
      for (const Figure& figure : discriminator(batch, made.detach())) loss.parts.push_back(figure);
    return {batch.poses.size(0), loss.parts};
  }
  Figures evaluate() override {
    const torch::NoGradGuard no_grad;
    return figures_.of(
        [this](const torch::Tensor& poses, const torch::Tensor& people) { return average_(poses, people); });
  }
  nn::WeightsHeader header() const override { return {"pose2d", nn::kPoseCodeVersion, {}}; }
  void put_own(torch::serialize::OutputArchive& archive) const override {
    put(archive, "judge", *judge_);
    put(archive, "judging", *judging_);
    put_random(archive, rng_.state());
  }
  void take_own(torch::serialize::InputArchive& archive) override {
    take(archive, "judge", *judge_);
    take(archive, "judging", *judging_);
    rng_ = Rng(take_random(archive));
  }

  nn::Pose2dTrainOptions options_;
  Rng rng_;
  PoseCodeData data_;
  PoseCodeFigures figures_;
  nn::PoseCodeGenerator net_, average_;
  nn::PoseCodeDiscriminator judge_;
  torch::Tensor pairs_, directions_;
  std::unique_ptr<torch::optim::RMSprop> judging_;
};

LossSum PoseCodeTrainer::generator(const PoseCodeBatch& batch, const torch::Tensor& made) {
  const auto judged = judge_(made);
  torch::Tensor features;
  {
    const torch::NoGradGuard no_grad;
    features = judge_(batch.own).features;
  }
  LossSum loss;
  loss.add("fooling", -scores_of(judged.scores, batch).mean());
  loss.add("features", (judged.features - features).abs().mean());
  const auto mask = batch.poses.select(2, 2);
  const int64_t within = batch.within, across = made.size(0) - within;
  const auto of_two = [&](const torch::Tensor& rows) { return rows.narrow(0, within, across); };
  loss.add(
      "same",
      same_pose_loss(made.narrow(0, 0, within), batch.whole.narrow(0, 0, within), mask.narrow(0, 0, within)),
      kSamePose);
  const auto is = of_two(made), was = of_two(batch.whole), counts = of_two(mask);
  if (options_.links == "virtual")
    loss.add("links", virtual_link_loss(is, was, counts, pairs_, directions_), kLinks);
  if (options_.links == "ranking")
    loss.add("links", link_ranking_loss(is, was, counts, pairs_, directions_), kLinks);
  if (options_.angles) loss.add("angle", bone_angle_loss(is, was, counts), kAngles);
  return loss;
}

Figures PoseCodeTrainer::discriminator(const PoseCodeBatch& batch, const torch::Tensor& made) {
  const auto real = scores_of(judge_(batch.own).scores, batch), fake = scores_of(judge_(made).scores, batch);
  judging_->zero_grad();
  (hinge_real(real) + hinge_made(fake)).backward();
  for (auto& group : judging_->param_groups()) group.options().set_lr(learning_rate());
  judging_->step();
  const auto right = ((real > 0).to(torch::kFloat).mean() + (fake < 0).to(torch::kFloat).mean()) / 2;
  return {{"discriminator_accuracy", right.item<double>()}};
}

}  // namespace

int train(const nn::Pose2dTrainOptions& options) {
  return PoseCodeTrainer(options).run();
}

}  // namespace understudy::training
