// What the hybrid engine learns from: stretches of motion as the trained extractor saw them, with its real
// errors, and what was true.
#pragma once

#include <string>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

/// One person in one stretch of motion, seen by one simulated rig.
struct HybridWindow {
  float dt = 1.0f / 30;              ///< seconds between frames
  std::vector<Extraction> seen;      ///< as extracted, a frame each, with rotations
  std::vector<PosedSkeleton> truth;  ///< as many
};

/// Windows of a train and of a dev split.
struct HybridCache {
  int frames = 60;  ///< of every window
  std::vector<HybridWindow> train, dev;
};

/// Makes windows: clips of the split on bodies of the split, scanned, then extracted.
class HybridWindowMaker {
 public:
  /// Throws Error when no clip has `frames` good frames in a row.
  HybridWindowMaker(const TrainingData& data, int frames, uint64_t seed);
  HybridWindow next(SkeletonExtractor& extractor);

 private:
  struct Run {
    int clip, first, count;  // frames without a flag
  };
  std::vector<Pose> poses(float& dt);

  const TrainingData& data_;
  int frames_;
  Rng rng_;
  ScanMaker maker_;
  std::vector<Run> runs_;
  std::vector<std::vector<int>> of_clip_;  // runs of each clip that has one
};

/// Written beside the path, then renamed.
void write_hybrid_cache(const std::string& path, const HybridCache& cache);
/// Throws Error when the file is missing, damaged or no such cache.
HybridCache read_hybrid_cache(const std::string& path);

/// The window seen in a mirror: sides exchanged, x -> -x.
HybridWindow mirrored(const HybridWindow& window);
/// The window with the extractor's errors `factor` times as large: 1 as it was, 0 without errors.
HybridWindow with_scaled_errors(const HybridWindow& window, float factor);

}  // namespace understudy::training
