#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/training/inbetween_data.hpp"
#include "retarget/training/losses/inbetween_losses.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kBatchFrames = 3072;
constexpr double kSlow = 0.2 / kClipRate;  // metres a frame of a foot that stands
constexpr int64_t kDevBatch = 64;
// Of the dev windows: known frames on each side, and how far apart the windows begin.
constexpr int kEnds = 10, kEvery = 30;

Schedule inbetween_schedule() {
  Schedule schedule;
  schedule.rate = 6e-4;
  schedule.warm_up = 300;
  schedule.average_decay = 0.999;
  schedule.row_seconds = 300;
  return schedule;
}

torch::Tensor placed_joints(const torch::Tensor& rest, const torch::Tensor& rotations,
                            const torch::Tensor& root) {
  return nn::forward_kinematics(rest, rotations).joints + root.unsqueeze(2);
}

/// Of each frame, [B, T]: 0 where all is known, else more the shorter the window's longest gap is: so much is
/// a curve off there.
torch::Tensor frame_weights(const torch::Tensor& distance) {
  const auto apart = distance.amin(-1).amax(-1);  // [B, T] frames to the nearest known one
  const auto longest = 2 * apart.amax(-1, true);  // [B, 1]
  return (apart > 0).to(distance.dtype()) / (0.005 + 0.003 * longest);
}

/// A frame's weight for what is between it and its neighbours.
torch::Tensor between(const torch::Tensor& weight, int64_t n) {
  auto least = weight.slice(1, n);
  for (int64_t i = 0; i < n; ++i) least = torch::max(least, weight.slice(1, i, weight.size(1) - n + i));
  return least;
}

LossSum inbetween_loss(const nn::InbetweenOutput& made, const InbetweenBatch& batch) {
  const auto& rest = batch.input.rest;
  const auto posed = nn::forward_kinematics(rest, made.rotations),
             truth = nn::forward_kinematics(rest, batch.rotations);
  const auto joints = posed.joints + made.root.unsqueeze(2),
             true_joints = truth.joints + batch.root.unsqueeze(2);
  const auto weight = frame_weights(batch.input.distance);
  const auto error = lengths(joints - true_joints);  // [B, T, 22]
  LossSum loss;
  loss.add("place", (weight * error.mean(-1)).mean());
  loss.add("around", (weight * lengths(posed.joints - truth.joints).mean(-1)).mean(), 0.5);
  loss.add("turn",
           (weight * (posed.global - truth.global).square().sum({-1, -2}).add(1e-6).sqrt().mean(-1)).mean(),
           0.1);
  loss.add("speed", (between(weight, 1) * difference_error(joints, true_joints, 1).mean(-1)).mean(), 3);
  loss.add("acceleration", (between(weight, 2) * difference_error(joints, true_joints, 2).mean(-1)).mean(),
           2);
  const auto feet =
      torch::tensor({int64_t(LeftAnkle), int64_t(LeftFoot), int64_t(RightAnkle), int64_t(RightFoot)});
  const auto made_feet = joints.index_select(2, feet), true_feet = true_joints.index_select(2, feet);
  loss.add("slide", (between(weight, 1) * sliding(made_feet, true_feet, kSlow).mean(-1)).mean(), 3);
  const auto toes = lengths(true_feet.diff(1, 1)).index_select(2, torch::tensor({int64_t(1), int64_t(3)}));
  const auto stands = (toes < kSlow).to(error.dtype());
  const auto unknown = (weight > 0).to(error.dtype());
  loss.add("standing",
           weighed_mean(torch::binary_cross_entropy_with_logits(made.standing.slice(1, 1), stands, {}, {},
                                                                at::Reduction::None),
                        unknown.slice(1, 1)),
           0.2);
  loss.add("doubt", weighed_mean((made.doubt - error.detach().mean(-1).add(1e-3).log()).abs(), unknown), 0.1);
  return loss;
}

class InbetweenTrainer final : public TrainingRun {
 public:
  explicit InbetweenTrainer(const nn::MotionSpaceTrainOptions& options);

 private:
  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override;
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  /// Mean error of joints over the frames that are not known, mm.
  double error_mm(const InbetweenBatch& batch, bool of_curve);

  int frames_ = kBatchFrames;
  nn::InbetweenOptions form_;
  Rng rng_;
  InbetweenData data_, dev_;
  nn::InbetweenNet net_, average_;
};

InbetweenTrainer::InbetweenTrainer(const nn::MotionSpaceTrainOptions& options)
    : TrainingRun(options, options.kNetwork, inbetween_schedule()),
      rng_(options.seed),
      data_(load_training_data(options.data, Split::Train)),
      dev_(load_training_data(options.data, Split::Dev)),
      net_(form_),
      average_(form_) {
  if (options.batch > 0) frames_ = options.batch;
  net_->to(device());
  own(net_.ptr(), average_.ptr(),
      std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                            torch::optim::AdamWOptions().weight_decay(0.01)));
  for (const int gap : {5, 15, 30, 60})
    log::info(detail::join("motion-space: Hermite, gap ", gap, ": ",
                           error_mm(dev_.gaps(gap, kEnds, kEvery, false), true), " mm; of those who travel ",
                           error_mm(dev_.gaps(gap, 5, 6, true), true)));
}

TrainingRun::Step InbetweenTrainer::learn() {
  const InbetweenBatch batch = data_.batch(frames_, rng_);
  const LossSum loss = inbetween_loss(net_->forward(batch.input), batch);
  loss.total.backward();
  return {batch.root.size(0), loss.parts};
}

double InbetweenTrainer::error_mm(const InbetweenBatch& batch, bool of_curve) {
  const torch::NoGradGuard no_grad;
  const auto cut = [](const torch::Tensor& t, int64_t i) { return t.slice(0, i, i + kDevBatch); };
  torch::Tensor sum = torch::zeros({}), count = torch::zeros({});
  for (int64_t i = 0; i < batch.root.size(0); i += kDevBatch) {
    const nn::InbetweenInput input{cut(batch.input.rotations, i), cut(batch.input.root, i),
                                   cut(batch.input.distance, i), cut(batch.input.rest, i)};
    const nn::InbetweenOutput made =
        of_curve ? nn::InbetweenOutput{input.rotations, input.root, {}, {}} : average_->forward(input);
    const auto error = lengths(placed_joints(input.rest, made.rotations, made.root) -
                               placed_joints(input.rest, cut(batch.rotations, i), cut(batch.root, i)));
    const auto unknown = (input.distance.amin(-1).amax(-1) > 0).to(error.dtype());
    sum += (error.mean(-1) * unknown).sum();
    count += unknown.sum();
  }
  return 1000 * sum.item<double>() / count.item<double>();
}

Figures InbetweenTrainer::evaluate() {
  Figures figures;
  for (const int gap : {5, 15, 30, 60})
    figures.push_back(
        {detail::join("dev_", gap, "_mm"), error_mm(dev_.gaps(gap, kEnds, kEvery, false), false)});
  for (const int gap : {15, 30, 60})
    figures.push_back({detail::join("dev_travel_", gap, "_mm"), error_mm(dev_.gaps(gap, 5, 6, true), false)});
  return figures;
}

nn::WeightsHeader InbetweenTrainer::header() const {
  return {"motion-space",
          nn::kInbetweenVersion,
          {{"width", static_cast<double>(form_.width)},
           {"inner", static_cast<double>(form_.inner)},
           {"layers", static_cast<double>(form_.layers)},
           {"heads", static_cast<double>(form_.heads)}}};
}

}  // namespace

int train(const nn::MotionSpaceTrainOptions& options) {
  return InbetweenTrainer(options).run();
}

}  // namespace understudy::training
