#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/training/inbetween_step.hpp"
#include "retarget/training/losses/inbetween_losses.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kBatchFrames = 3072;
constexpr int64_t kDevBatch = 64;
// Of the dev windows: known frames on each side, and how far apart the windows begin.
constexpr int kEnds = 10, kEvery = 30;
/// Of the windows so many are told the code of the truth.
constexpr float kTold = 0.4f;
/// Weight of the codes' divergence from the standard normal distribution, and after which share of the
/// training it is reached: from the start on codes would be given up before they tell anything.
constexpr double kDivergence = 0.003, kDivergenceGrows = 0.6;

Schedule inbetween_schedule(bool begun) {
  Schedule schedule;
  schedule.rate = begun ? 3e-4 : 6e-4;
  schedule.warm_up = 300;
  schedule.average_decay = 0.999;
  schedule.row_seconds = 300;
  return schedule;
}

/// Of Kullback and Leibler, from the standard normal distribution, [B, C].
torch::Tensor divergence(const nn::MovementCode& code) {
  return 0.5 * (code.mean.square() + (2 * code.log_deviation).exp() - 1) - code.log_deviation;
}

torch::Tensor placed_joints(const torch::Tensor& rest, const torch::Tensor& rotations,
                            const torch::Tensor& root) {
  return nn::forward_kinematics(rest, rotations).joints + root.unsqueeze(2);
}

class InbetweenTrainer final : public TrainingRun {
 public:
  explicit InbetweenTrainer(const nn::MotionSpaceTrainOptions& options);

 private:
  Step learn() override;
  Figures evaluate() override { return dev_errors(false); }
  nn::WeightsHeader header() const override;
  bool may_lack(const std::string& tensor) const override { return starts_with(tensor, nn::kMovementCodes); }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  /// Of the dev windows, by the curve alone or by the network.
  Figures dev_errors(bool of_curve);
  /// Mean error of joints over the frames that are not known, mm.
  double error_mm(const InbetweenBatch& batch, bool of_curve);

  int frames_ = kBatchFrames;
  nn::InbetweenOptions form_;
  Rng rng_;
  InbetweenData data_, dev_;
  nn::InbetweenNet net_, average_;
};

InbetweenTrainer::InbetweenTrainer(const nn::MotionSpaceTrainOptions& options)
    : TrainingRun(options, options.kNetwork, inbetween_schedule(!options.init.empty())),
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
  for (const Figure& figure : dev_errors(true))
    log::info(detail::join("motion-space: the curve alone, ", figure.name, " ", figure.value));
}

TrainingRun::Step InbetweenTrainer::learn() {
  const InbetweenBatch batch = data_.batch(frames_, rng_);
  const int64_t windows = batch.root.size(0);
  const nn::MovementCode code =
      net_->encode({batch.rotations, batch.root, batch.input.distance, batch.input.rest});
  const auto noise = torch::empty({windows, form_.code}), told = torch::empty({windows, 1});
  std::generate_n(noise.data_ptr<float>(), noise.numel(), [this] { return rng_.normal(); });
  std::generate_n(told.data_ptr<float>(), windows, [this] { return rng_.chance(kTold) ? 1.f : 0.f; });
  const auto sample = code.mean + code.log_deviation.exp() * noise.to(device());
  LossSum loss = inbetween_loss(net_->forward(batch.input, sample, told.to(device())), batch);
  loss.add("code", (told.to(device()) * divergence(code)).sum() / static_cast<double>(windows),
           kDivergence * std::min(1.0, done_share() / kDivergenceGrows));
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

Figures InbetweenTrainer::dev_errors(bool of_curve) {
  Figures figures;
  const auto add = [&](const char* name, int gap, int ends, int every, bool travelling) {
    if (const auto windows = dev_.gaps(gap, ends, every, travelling))
      figures.push_back({detail::join(name, gap, "_mm"), error_mm(*windows, of_curve)});
  };
  for (const int gap : {5, 15, 30, 60}) add("dev_", gap, kEnds, kEvery, false);
  for (const int gap : {15, 30, 60}) add("dev_travel_", gap, 5, 6, true);
  return figures;
}

nn::WeightsHeader InbetweenTrainer::header() const {
  return {"motion-space",
          nn::kInbetweenVersion,
          {{"width", static_cast<double>(form_.width)},
           {"inner", static_cast<double>(form_.inner)},
           {"layers", static_cast<double>(form_.layers)},
           {"heads", static_cast<double>(form_.heads)},
           {"code", static_cast<double>(form_.code)}}};
}

}  // namespace

int train(const nn::MotionSpaceTrainOptions& options) {
  return options.form == "paper" ? train_steps(options) : InbetweenTrainer(options).run();
}

}  // namespace understudy::training
