// `understudy train motion`: the loop around MotionTrainer.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/motion_evaluator.hpp"
#include "retarget/training/motion_trainer.hpp"

namespace understudy::training {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kCheckpointMinutes = 2, kReportMinutes = 0.5;
constexpr float kEvaluatedNoise = 0.02f;  // metres

double minutes_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count() / 60;
}

/// Means of the steps since the last report.
class Recent {
 public:
  void add(const MotionStep& step) {
    sum_.cycle += step.cycle;
    sum_.rotation += step.rotation;
    sum_.smoothness += step.smoothness;
    sum_.adversarial += step.adversarial;
    sum_.accuracy += step.accuracy;
    ++count_;
  }
  MotionStep mean() const {
    const double n = std::max(1, count_);
    return {sum_.cycle / n, sum_.rotation / n, sum_.smoothness / n, sum_.adversarial / n, sum_.accuracy / n};
  }
  void clear() { *this = {}; }

 private:
  MotionStep sum_;
  int count_ = 0;
};

struct Evaluators {
  MotionEvaluator clean, noisy;
  explicit Evaluators(const TrainingData& dev) : clean(dev, 0), noisy(dev, kEvaluatedNoise) {}
};

void append_curve(const std::string& path, const MotionTrainer& trainer, const MotionStep& losses,
                  const MotionFigures& clean, const MotionFigures& noisy) {
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (fresh)
    out << "minutes,samples,cycle,rotation,smoothness,adversarial,discriminator_accuracy,dev_mpjpe_mm,dev_pa_"
           "mpjpe_mm,"
           "dev_rot_deg,dev_noisy_mpjpe_mm,dev_noisy_pa_mpjpe_mm,dev_noisy_rot_deg\n";
  out << trainer.minutes << ',' << trainer.samples << ',' << losses.cycle << ',' << losses.rotation << ','
      << losses.smoothness << ',' << losses.adversarial << ',' << losses.accuracy << ',' << clean.mpjpe_mm
      << ',' << clean.pa_mpjpe_mm << ',' << clean.rot_deg << ',' << noisy.mpjpe_mm << ',' << noisy.pa_mpjpe_mm
      << ',' << noisy.rot_deg << '\n';
  US_CHECK(out.good(), path, ": cannot be written");
}

std::string losses_line(const MotionTrainer& trainer, const MotionStep& losses) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(1) << "motion: " << trainer.minutes << " min, " << trainer.samples
       << " sequences, joints rmse " << 1000 * std::sqrt(losses.cycle) << " mm, " << std::setprecision(5)
       << "rotation " << losses.rotation << ", smoothness " << losses.smoothness << std::setprecision(3)
       << ", adversarial " << losses.adversarial << ", discriminator right " << losses.accuracy;
  return line.str();
}

std::string figures_line(const MotionFigures& clean, const MotionFigures& noisy) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(1) << "motion: dev mpjpe " << clean.mpjpe_mm << " mm, pa "
       << clean.pa_mpjpe_mm << " mm, rotations " << clean.rot_deg << " deg; with " << 1000 * kEvaluatedNoise
       << " mm of noise " << noisy.mpjpe_mm << " / " << noisy.pa_mpjpe_mm << " mm, " << noisy.rot_deg
       << " deg";
  return line.str();
}

/// Evaluators, then writes the curve's next line, the weights and the checkpoint.
void keep(MotionTrainer& trainer, const Evaluators& evaluators, const MotionStep& losses,
          const nn::TrainOptions& options) {
  const nn::MotionGruOptions form = trainer.form();
  const MotionFigures clean = evaluators.clean.evaluate(trainer.net),
                      noisy = evaluators.noisy.evaluate(trainer.net);
  log::info(figures_line(clean, noisy));
  append_curve(options.curve.empty() ? options.out + ".csv" : options.curve, trainer, losses, clean, noisy);
  nn::save_weights(options.out,
                   {"motion",
                    nn::kMotionGruVersion,
                    {{"hidden", static_cast<double>(form.hidden)},
                     {"layers", static_cast<double>(form.layers)},
                     {"quaternions", form.quaternions ? 1.0 : 0.0},
                     {"samples", static_cast<double>(trainer.samples)},
                     {"minutes", trainer.minutes},
                     {"dev_mpjpe_mm", clean.mpjpe_mm},
                     {"dev_pa_mpjpe_mm", clean.pa_mpjpe_mm},
                     {"dev_rot_deg", clean.rot_deg},
                     {"dev_noisy_mpjpe_mm", noisy.mpjpe_mm},
                     {"dev_noisy_pa_mpjpe_mm", noisy.pa_mpjpe_mm}}},
                   *trainer.net);
  trainer.save_checkpoint(options.out + ".checkpoint");
}

double progress_of(const MotionTrainer& trainer, const nn::TrainOptions& options) {
  double progress = 0;
  if (options.samples > 0)
    progress = static_cast<double>(trainer.samples) / static_cast<double>(options.samples);
  if (options.minutes > 0) progress = std::max(progress, trainer.minutes / options.minutes);
  return progress;
}

MotionTrainerOptions trainer_options(const nn::TrainOptions& options) {
  US_CHECK(options.device == "cpu" || torch::cuda::is_available(), "this LibTorch finds no ", options.device,
           " device");
  MotionTrainerOptions made;
  if (options.batch > 0) made.batch.size = options.batch;
  if (options.context > 0) made.batch.frames = options.context;
  made.net.quaternions = options.rotation == "quaternion";
  if (!options.rotation_loss) made.rotation_weight = 0;
  made.seed = options.seed;
  made.device = options.device;
  return made;
}

}  // namespace

int train_motion(const nn::TrainOptions& options) {
  US_CHECK(!options.out.empty(), "train motion wants a file for the weights");
  at::set_num_threads(std::max(1, options.threads));  // these matrices are small: one thread unless told
  const TrainingData dev = load_training_data(options.data, Split::Dev);
  const MotionData data(load_training_data(options.data, Split::Train));
  const Evaluators evaluators(dev);
  MotionTrainer trainer(trainer_options(options));
  if (const std::string checkpoint = options.out + ".checkpoint"; std::filesystem::exists(checkpoint)) {
    trainer.load_checkpoint(checkpoint);
    log::info("motion: goes on from " + checkpoint);
  } else if (!options.init.empty()) {
    nn::load_weights(options.init, "motion", nn::kMotionGruVersion, *trainer.net);
  }
  log::info(detail::join("motion: ", data.stretches(), " stretches of motion, each on its own body"));

  const double before = trainer.minutes;
  const auto start = Clock::now();
  double reported = before, kept = before;
  Recent recent;
  bool cancelled = false;
  while (progress_of(trainer, options) < 1 && !cancelled) {
    recent.add(trainer.step(data, progress_of(trainer, options)));
    trainer.minutes = before + minutes_since(start);
    if (trainer.minutes - reported > kReportMinutes) {
      log::info(losses_line(trainer, recent.mean()));
      reported = trainer.minutes;
    }
    if (trainer.minutes - kept > kCheckpointMinutes) {
      keep(trainer, evaluators, recent.mean(), options);
      recent.clear();
      kept = trainer.minutes;
    }
    cancelled = options.cancelled && options.cancelled();
  }
  keep(trainer, evaluators, recent.mean(), options);
  return cancelled ? 1 : 0;
}

}  // namespace understudy::training
