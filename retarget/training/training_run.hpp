// A training run: what all trainers have in common. Schedule, running average of the weights, checkpoint and
// resume, learning curve, stop.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <string>

#include "retarget/networks/train_options.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

struct Schedule {
  double rate = 1e-3;  ///< highest learning rate; after the warm-up it falls along a cosine over the training
  double last_rate = 0.01;   ///< share of it that is left at the end
  int warm_up = 0;           ///< steps
  double most_gradient = 1;  ///< norm that gradients are cut to
  double average_decay = 0;  ///< of the running average of the weights, a step; 0: the weights as they are
  int first_row = 100;       ///< step of the learning curve's first row
  double row_seconds = 120;  ///< between rows; with each, weights and checkpoint are written
};

// Parts of a checkpoint in LibTorch's archives.

/// A module or an optimizer under a name.
template <class Part>
void put(torch::serialize::OutputArchive& archive, const char* key, const Part& part) {
  torch::serialize::OutputArchive inner;
  part.save(inner);
  archive.write(key, inner);
}

template <class Part>
void take(torch::serialize::InputArchive& archive, const char* key, Part& part) {
  torch::serialize::InputArchive inner;
  archive.read(key, inner);
  part.load(inner);
}

/// The state of a random number generator, by whose number the next batch is made.
inline void put_random(torch::serialize::OutputArchive& archive, uint64_t state) {
  archive.write("random", torch::tensor(static_cast<int64_t>(state), torch::kLong));
}

inline uint64_t take_random(torch::serialize::InputArchive& archive) {
  torch::Tensor state;
  archive.read("random", state);
  return static_cast<uint64_t>(state.item<int64_t>());
}

/// How far a training has come.
struct TrainingProgress {
  int64_t step = 0, samples = 0;
  double seconds = 0;  ///< spent so far, over all runs
};

/// A trainer is a TrainingRun with networks, data and a step. Its constructor calls own() once.
class TrainingRun {
 public:
  virtual ~TrainingRun() = default;
  TrainingRun(const TrainingRun&) = delete;
  TrainingRun& operator=(const TrainingRun&) = delete;

  /// Trains to the end of the options' minutes or samples: 0, or 1 when it was cancelled. Throws Error, too
  /// where one step after another has no finite loss or gradient.
  int run();

 protected:
  struct Step {
    int64_t samples = 0;
    Figures losses;
  };

  /// Checks the options that all networks have; seeds LibTorch and sets its threads.
  TrainingRun(const nn::TrainOptions& options, std::string network, const Schedule& schedule);
  /// The network, where the running average of its weights is to be, and the optimizer of its parameters. On
  /// the device already; weights to start from are read here.
  void own(std::shared_ptr<torch::nn::Module> net, std::shared_ptr<torch::nn::Module> average,
           std::unique_ptr<torch::optim::Optimizer> optimizer);

  /// Gradients of a fresh batch into the network's parameters, which have none.
  virtual Step learn() = 0;
  /// How good the running average is on data that is not trained on.
  virtual Figures evaluate() = 0;
  /// Kind, version and sizes in the header of the weights.
  virtual nn::WeightsHeader header() const = 0;
  /// Whether weights to start from may lack that tensor.
  virtual bool may_lack(const std::string&) const { return false; }
  /// What else the next step depends on, in the checkpoint; progress() is known when it is taken.
  virtual void put_own(torch::serialize::OutputArchive&) const {}
  virtual void take_own(torch::serialize::InputArchive&) {}

  const TrainingProgress& progress() const { return progress_; }
  /// Of the training, 0 .. 1.
  double done_share() const;
  double learning_rate() const;
  const torch::Device& device() const { return device_; }

 private:
  void resume();
  void take_checkpoint();
  void step();
  void skip();
  void update_average();
  void write();
  void write_checkpoint() const;
  void write_weights() const;
  void add_row();
  void append_row(const Figures& row);
  void log_figures(const Figures& row) const;
  Figures figures() const;
  std::string checkpoint() const { return options_.out + ".checkpoint"; }

  nn::TrainOptions options_;
  std::string network_;
  Schedule schedule_;
  torch::Device device_;
  std::shared_ptr<torch::nn::Module> net_, average_;
  std::unique_ptr<torch::optim::Optimizer> optimizer_;
  std::vector<torch::Tensor> first_;  // parameters that training started from, where a share is kept
  TrainingProgress progress_;
  RunningMean losses_;  // since the last row
  Figures dev_;         // of the last row
  int skipped_ = 0;     // steps since the last row
  int skipped_in_a_row_ = 0;
  bool curve_begun_ = false;
};

/// Where neither minutes nor samples tell an end, after so many samples.
template <class Options>
Options with_end(Options options, int64_t samples) {
  if (options.minutes <= 0 && options.samples <= 0) options.samples = samples;
  return options;
}

/// See nn::train; each in the file of its trainer. Samples are scans, for motion sequences, for deformation
/// points.
int train(const nn::SkeletonTrainOptions& options);
int train(const nn::PartTrainOptions& options);
int train(const nn::MotionTrainOptions& options);
int train(const nn::DeformationTrainOptions& options);
int train(const nn::MotionSpaceTrainOptions& options);
/// Samples are words.
int train(const nn::StyleTrainOptions& options);
/// Samples are clips, of which some words are looked at; where the options have no end there is one.
int train(const nn::StyleJudgeTrainOptions& options);
/// Samples are poses; where the options have no end there is one.
int train(const nn::ProportionsTrainOptions& options);
/// Samples are pairs of poses.
int train(const nn::Pose2dTrainOptions& options);
/// Samples are sequences; where the options have no end there is one.
int train(const nn::LifterTrainOptions& options);
int train(const nn::PointsTrainOptions& options);
/// Samples are windows.
int train(const nn::MarionetteSlotsTrainOptions& options);
/// Samples are windows of ten frames.
int train(const nn::MarionettePaperTrainOptions& options);
/// Samples are motions; where the options have no end there is one.
int train(const nn::MarionetteDynamicsTrainOptions& options);
/// Of the form "paper"; samples are steps.
int train_steps(const nn::MotionSpaceTrainOptions& options);

}  // namespace understudy::training
