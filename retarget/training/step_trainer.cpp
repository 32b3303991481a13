#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/motion_space/linear_coder.hpp"
#include "retarget/motion_space/step_score.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/training/step_loss.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kStepBatch = 256;
constexpr double kPhaseOne = 0.2;  // share of the training
constexpr int kBalanceEvery = 10;  // steps
constexpr StepScoreOptions kDevScore{20, 60};

Schedule step_schedule() {
  Schedule schedule;
  schedule.rate = 1e-3;
  schedule.warm_up = 200;
  schedule.most_gradient = 5;
  schedule.average_decay = 0.999;
  return schedule;
}

/// The clips of a split and who performs them.
struct StepFolder {
  StepFolder(const std::string& folder, const char* name, double share) {
    const DataSplit split = read_split(folder, name);
    mean = mean_body(split);
    double taken = 0;  // so that those of each kind, which lie together, count alike
    for (StepClip& clip : read_step_clips(split, mean.joints))
      if ((taken += share) >= 1) taken -= 1, clips.push_back(std::move(clip));
    US_CHECK(!clips.empty(), folder, ": ", share, " of its clips are none");
  }
  ShapedBody mean;
  std::vector<StepClip> clips;
};

/// Begins as the linear space of the steps, each number counting as much as it moves the surface.
void begin_linear(const StepFolder& folder, nn::StepCvae& net) {
  const RowMatrix rows = step_rows(folder.clips, leg_length(folder.mean.joints));
  const auto code = static_cast<int>(net->options().code);
  const LinearSpace space(rows, surface_reach(folder.mean, rows.colwise().mean()), code);
  net->begin_linear(nn::tensor_of(space.mean).squeeze(1), nn::tensor_of(space.to_codes),
                    nn::tensor_of(space.to_movements));
}

nn::StepCvaeOptions form_of(const nn::MotionSpaceTrainOptions& options) {
  nn::StepCvaeOptions form;
  form.code = options.code;
  form.told = options.told;
  form.timed = options.timed;
  return form;
}

class StepTrainer final : public TrainingRun {
 public:
  explicit StepTrainer(const nn::MotionSpaceTrainOptions& options);

 private:
  Step learn() override;
  Figures evaluate() override;
  nn::WeightsHeader header() const override;
  void put_own(torch::serialize::OutputArchive& archive) const override;
  void take_own(torch::serialize::InputArchive& archive) override;

  int count_ = kStepBatch;
  StepLossOptions loss_;
  bool two_phases_;
  nn::StepCvaeOptions form_;
  Rng rng_;
  StepFolder train_, dev_;
  StepData data_;
  SurfaceDistance surface_;
  StepBalances balances_;
  nn::StepCvae net_, average_;
};

StepTrainer::StepTrainer(const nn::MotionSpaceTrainOptions& options)
    : TrainingRun(options, options.kNetwork, step_schedule()),
      two_phases_(options.surface),
      form_(form_of(options)),
      rng_(options.seed),
      train_(options.data, "train", options.clips),
      dev_(options.data, "dev", 1),
      data_(train_.clips, leg_length(train_.mean.joints)),
      surface_(train_.mean),
      balances_{LossBalance(options.timed ? 3 : 2), LossBalance(options.timed ? 2 : 1)},
      net_(form_),
      average_(form_) {
  US_CHECK(device().is_cpu(), "steps are learned on the CPU");
  if (options.batch > 0) count_ = options.batch;
  loss_.kl = options.kl;
  for (nn::StepCvae* net : {&net_, &average_})
    (*net)->set_usual(nn::tensor_of(train_.mean.joints), data_.mean_seconds());
  begin_linear(train_, net_);
  own(net_.ptr(), average_.ptr(),
      std::make_unique<torch::optim::AdamW>(net_->parameters(),
                                            torch::optim::AdamWOptions().weight_decay(0.01)));
}

TrainingRun::Step StepTrainer::learn() {
  const StepBatch batch = data_.batch(count_, rng_);
  auto noise = torch::empty({count_, form_.code});
  for (int64_t i = 0; i < noise.numel(); ++i) noise.data_ptr<float>()[i] = rng_.normal();
  loss_.on_surface = two_phases_ && done_share() >= kPhaseOne;
  loss_.balance = progress().step % kBalanceEvery == 0;
  const LossSum loss = step_loss(net_, batch, noise, surface_, loss_, balances_);
  loss.total.backward();
  return {count_, loss.parts};
}

Figures StepTrainer::evaluate() {
  const auto coder = nn::step_coder(average_);
  const StepScore score = score_steps(*coder, dev_.clips, dev_.mean, kDevScore);
  return {{"dev_mm", score.all.joints_mm},
          {"dev_vertices_mm", score.all.vertices_mm},
          {"dev_duration_ms", score.all.duration_ms},
          {"dev_walks_mm", score.walks.joints_mm},
          {"dev_walks_vertices_mm", score.walks.vertices_mm},
          {"dev_walks_duration_ms", score.walks.duration_ms}};
}

nn::WeightsHeader StepTrainer::header() const {
  return {"motion-steps",
          nn::kStepCvaeVersion,
          {{"code", static_cast<double>(form_.code)},
           {"width", static_cast<double>(form_.width)},
           {"told", form_.told ? 1.0 : 0.0},
           {"timed", form_.timed ? 1.0 : 0.0}}};
}

void StepTrainer::put_own(torch::serialize::OutputArchive& archive) const {
  put_random(archive, rng_.state());
  archive.write("balance_numbers", balances_.numbers.state());
  archive.write("balance_surface", balances_.surface.state());
}

void StepTrainer::take_own(torch::serialize::InputArchive& archive) {
  rng_ = Rng(take_random(archive));
  torch::Tensor state;
  archive.read("balance_numbers", state);
  balances_.numbers.set_state(state);
  archive.read("balance_surface", state);
  balances_.surface.set_state(state);
}

}  // namespace

int train_steps(const nn::MotionSpaceTrainOptions& options) {
  return StepTrainer(options).run();
}

}  // namespace understudy::training
