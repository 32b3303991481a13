#include <utility>

#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/training/point_data.hpp"
#include "retarget/training/training_run.hpp"

namespace understudy::training {
namespace {

constexpr int kPointBatch = 32, kPointFrames = 45, kPointFigureCases = 60;
constexpr int64_t kUsualShots = 80000;  // about 3 core-minutes
constexpr double kJitterWeight = 26;    // points of similarity that one truth's worth of jitter is worth
constexpr double kCalmEnough = 0.9;     // of the truth's jitter
constexpr int kColumns = 8;             // of the numbers
constexpr uint64_t kPointFigureSeed = 20210204;
constexpr float kPointFigureJitter = 0.015f, kPointFigureMissing = 0.08f;

Schedule point_schedule() {
  Schedule schedule;
  schedule.rate = 5e-3;
  schedule.average_decay = 0.99;
  schedule.row_seconds = 60;
  return schedule;
}

class PointTrainer final : public TrainingRun {
 public:
  explicit PointTrainer(const nn::PointsTrainOptions& options)
      : TrainingRun(options, options.kNetwork, point_schedule()),
        options_(options),
        rng_(options.seed),
        data_(load_training_data(options.data, Split::Train), kPointFrames) {
    net_->to(device());
    average_->to(device());
    own(net_.ptr(), average_.ptr(),
        std::make_unique<torch::optim::Adam>(net_->parameters(), torch::optim::AdamOptions(1e-3)));
    const PointData dev(load_training_data(options.data, Split::Dev), kPointFrames);
    for (const float jitter : {0.0f, kPointFigureJitter}) {
      DetectorErrors errors;
      errors.jitter_m = jitter;
      if (jitter > 0) errors.missing = kPointFigureMissing;
      Rng rng(kPointFigureSeed);
      dev_.push_back(dev.plain(kPointFigureCases, errors, rng));
    }
  }

  /// As the source code has them.
  void write_numbers() const {
    std::string text;
    int column = 0;
    for (const float number : average_->numbers())
      text += printed("%.6g,%s", static_cast<double>(number), ++column % kColumns == 0 ? "\n" : " ");
    write_file(options_.out + ".inc", text);
  }

 private:
  Step learn() override {
    const int count = options_.batch > 0 ? options_.batch : kPointBatch;
    const PointBatch batch = data_.batch(count, rng_);
    const PointFigures figures = point_figures(net_(batch.seen), batch.truth);
    LossSum loss;
    loss.add("oks", (100 - figures.oks).mean());
    loss.add("jitter", figures.jitter.clamp_min(kCalmEnough).mean(), kJitterWeight);
    loss.total.backward();
    return {count, loss.parts};
  }
  Figures evaluate() override {
    const torch::NoGradGuard no_grad;
    Figures all;
    for (const char* name : {"clean", "seen"}) {
      const PointBatch& batch = dev_[all.size() / 2];
      const PointFigures figures = point_figures(average_(batch.seen), batch.truth);
      all.push_back({std::string("oks_") + name, figures.oks.mean().item<double>()});
      all.push_back({std::string("jitter_") + name, figures.jitter.mean().item<double>()});
    }
    return all;
  }
  nn::WeightsHeader header() const override { return {"points", 1, {}}; }
  void put_own(torch::serialize::OutputArchive& archive) const override { put_random(archive, rng_.state()); }
  void take_own(torch::serialize::InputArchive& archive) override { rng_ = Rng(take_random(archive)); }

  nn::PointsTrainOptions options_;
  Rng rng_;
  PointData data_;
  std::vector<PointBatch> dev_;
  mutable nn::PointGainsNet net_, average_;
};

}  // namespace

int train(const nn::PointsTrainOptions& options) {
  PointTrainer trainer(with_end(options, kUsualShots));
  const int status = trainer.run();
  if (status == 0) trainer.write_numbers();
  return status;
}

}  // namespace understudy::training
