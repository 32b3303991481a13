// `understudy train hybrid`: the windows, and the loop around HybridTrainer.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/network_extractor.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/hybrid_trainer.hpp"

namespace understudy::training {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kCheckpointMinutes = 2, kCacheMinutes = 2;
constexpr int kFrames = 60;      // of a window: two seconds
constexpr int kTrainToDev = 10;  // train windows for each dev window
constexpr int kDevWindows = 80;  // at most

double minutes_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count() / 60;
}

bool cancelled(const nn::TrainOptions& options) {
  return options.cancelled && options.cancelled();
}

int dev_windows(const nn::TrainOptions& options) {
  return std::clamp(options.windows / kTrainToDev, 1, kDevWindows);
}

/// Adds windows until there are `count`; false when it was cancelled.
bool add_windows(std::vector<HybridWindow>& windows, int count, const TrainingData& data, uint64_t seed,
                 const nn::TrainOptions& options, HybridCache& cache) {
  if (static_cast<int>(windows.size()) >= count) return true;
  // The eyes that the engine has: limbs and head are looked at from near.
  const auto extractor = nn::load_network_extractor(options.weights + "/skeleton.weights", "dense",
                                                    nn::load_leaf_refiner(options.weights + "/leaf.weights"));
  HybridWindowMaker maker(data, kFrames, seed + 1000 * windows.size());
  const auto start = Clock::now();
  const size_t had = windows.size();
  double written = 0;
  while (static_cast<int>(windows.size()) < count) {
    if (cancelled(options)) return false;
    windows.push_back(maker.next(*extractor));
    const double minutes = minutes_since(start);
    if (minutes - written < kCacheMinutes && static_cast<int>(windows.size()) < count) continue;
    write_hybrid_cache(options.cache, cache);
    written = minutes;
    log::info(detail::join("hybrid: ", windows.size(), " windows of ", count, ", ",
                           static_cast<int>(kFrames * (windows.size() - had) / (60 * minutes)),
                           " frames extracted a second"));
  }
  return true;
}

/// The cache with as many windows as asked, made as far as they are missing; false when it was cancelled.
bool fill_cache(HybridCache& cache, const TrainingData& train, const TrainingData& dev,
                const nn::TrainOptions& options) {
  cache.frames = kFrames;
  if (std::filesystem::exists(options.cache)) cache = read_hybrid_cache(options.cache);
  US_CHECK(cache.frames == kFrames, options.cache, ": its windows have ", cache.frames, " frames, not ",
           kFrames);
  return add_windows(cache.dev, dev_windows(options), dev, options.seed + 77, options, cache) &&
         add_windows(cache.train, options.windows, train, options.seed, options, cache);
}

std::vector<Joints> bodies_of(const TrainingData& data) {
  std::vector<Joints> bodies;
  for (const auto& betas : data.betas) bodies.push_back(data.body.shaped(betas).joints);
  for (const auto& dressed : data.dressed) bodies.push_back(dressed.joints);
  return bodies;
}

void append_curve(const std::string& path, const HybridTrainer& trainer, const HybridStep& losses,
                  const HybridFigures& figures) {
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (fresh)
    out << "minutes,frames,rotation,position,acceleration,dev_mpjpe_mm,dev_pa_mpjpe_mm,dev_rot_deg,dev_acc_"
           "mm,"
           "solve_mpjpe_mm,solve_pa_mpjpe_mm,solve_rot_deg,solve_acc_mm\n";
  out << trainer.minutes << ',' << trainer.samples << ',' << losses.rotation << ',' << losses.position << ','
      << losses.acceleration;
  for (const MotionFigures& f : {figures.hybrid, figures.solve})
    out << ',' << f.mpjpe_mm << ',' << f.pa_mpjpe_mm << ',' << f.rot_deg << ',' << f.acc_mm;
  out << '\n';
  US_CHECK(out.good(), path, ": cannot be written");
}

/// Judges, then writes the curve's next line, the weights and the checkpoint.
void keep(HybridTrainer& trainer, const HybridBatch& dev, const HybridStep& losses,
          const nn::TrainOptions& options) {
  const HybridFigures figures = judge_hybrid(trainer.average, dev);
  char line[300];
  std::snprintf(
      line, sizeof line,
      "hybrid: %.1f min, %lld frames, loss %.4f rad %.2f mm %.2f mm/frame^2; dev mpjpe %.2f mm (solve "
      "%.2f), pa %.2f (%.2f), %.2f deg (%.2f), acc %.2f mm (%.2f)",
      trainer.minutes, static_cast<long long>(trainer.samples), losses.rotation, 1000 * losses.position,
      1000 * losses.acceleration, figures.hybrid.mpjpe_mm, figures.solve.mpjpe_mm, figures.hybrid.pa_mpjpe_mm,
      figures.solve.pa_mpjpe_mm, figures.hybrid.rot_deg, figures.solve.rot_deg, figures.hybrid.acc_mm,
      figures.solve.acc_mm);
  log::info(line);
  append_curve(options.curve.empty() ? options.out + ".csv" : options.curve, trainer, losses, figures);
  const nn::HybridGruOptions form;
  nn::save_weights(options.out,
                   {"hybrid",
                    nn::kHybridVersion,
                    {{"hidden", static_cast<double>(form.hidden)},
                     {"layers", static_cast<double>(form.layers)},
                     {"frames", static_cast<double>(trainer.samples)},
                     {"minutes", trainer.minutes},
                     {"dev_pa_mpjpe_mm", figures.hybrid.pa_mpjpe_mm},
                     {"dev_rot_deg", figures.hybrid.rot_deg}}},
                   *trainer.average);
  trainer.save_checkpoint(options.out + ".checkpoint");
}

double progress_of(const HybridTrainer& trainer, const nn::TrainOptions& options) {
  const double by_samples =
      options.samples > 0 ? static_cast<double>(trainer.samples) / static_cast<double>(options.samples) : 0;
  return std::max(by_samples, options.minutes > 0 ? trainer.minutes / options.minutes : 0);
}

HybridTrainer make_trainer(const nn::TrainOptions& options, const TrainingData& data) {
  US_CHECK(options.device == "cpu" || torch::cuda::is_available(), "this LibTorch finds no ", options.device,
           " device");
  HybridTrainerOptions made;
  if (options.batch > 0) made.batch = options.batch;
  made.seed = options.seed;
  made.device = options.device;
  HybridTrainer trainer(made, bodies_of(data));
  if (const std::string checkpoint = options.out + ".checkpoint"; std::filesystem::exists(checkpoint)) {
    trainer.load_checkpoint(checkpoint);
    log::info("hybrid: goes on from " + checkpoint);
  } else if (!options.init.empty()) {
    nn::load_weights(options.init, "hybrid", nn::kHybridVersion, *trainer.net);
  }
  return trainer;
}

/// Means of the steps since the last report.
HybridStep mean_of(const std::vector<HybridStep>& steps) {
  HybridStep mean;
  for (const HybridStep& s : steps) {
    const auto n = static_cast<double>(steps.size());
    mean.rotation += s.rotation / n, mean.position += s.position / n, mean.acceleration += s.acceleration / n;
  }
  return mean;
}

}  // namespace

int train_hybrid(const nn::TrainOptions& options) {
  US_CHECK(!options.out.empty(), "train hybrid wants a file for the weights");
  US_CHECK(!options.cache.empty(), "train hybrid wants --cache, a file for what the extractor sees");
  at::set_num_threads(std::max(1, options.threads));  // these matrices are small: one thread unless told
  const TrainingData train = load_training_data(options.data, Split::Train),
                     dev = load_training_data(options.data, Split::Dev);
  HybridCache cache;
  if (!fill_cache(cache, train, dev, options)) return 1;
  Rng rng(7);
  const HybridBatch judged = make_hybrid_batch(cache.dev, bodies_of(dev), rng);
  HybridTrainer trainer = make_trainer(options, train);

  const double before = trainer.minutes;
  const auto start = Clock::now();
  double kept = before;
  std::vector<HybridStep> recent;
  bool stopped = false;
  while (progress_of(trainer, options) < 1 && !stopped) {
    recent.push_back(trainer.step(cache.train, progress_of(trainer, options)));
    trainer.minutes = before + minutes_since(start);
    if (trainer.minutes - kept > kCheckpointMinutes) {
      keep(trainer, judged, mean_of(recent), options);
      recent.clear();
      kept = trainer.minutes;
    }
    stopped = cancelled(options);
  }
  keep(trainer, judged, mean_of(recent), options);
  return stopped ? 1 : 0;
}

}  // namespace understudy::training
