#include "retarget/training/proportion_figures.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"
#include "retarget/pose2d/flat_people.hpp"
#include "retarget/pose2d/limb_transfer.hpp"
#include "retarget/pose2d/proportion_estimate.hpp"
#include "retarget/training/proportion_data.hpp"

namespace understudy::training {
namespace {

constexpr int kShortestTrack = 20, kTrackStep = 6;  // two seconds, where a clip is so long
constexpr uint64_t kFigureSeed = 20210203;
constexpr float kFigurePitch = kPi / 12, kJitter = 0.015f;

struct SuiteKind {
  const char* name;
  bool odd, noisy, seen;
};
constexpr std::array<SuiteKind, 4> kSuites = {{{"real", false, false, false},
                                               {"odd", true, false, false},
                                               {"noisy", true, true, false},
                                               {"seen", true, true, true}}};

DetectorErrors errors_of(const SuiteKind& kind, int number) {
  DetectorErrors errors;
  if (kind.noisy) errors.jitter_m = kJitter;
  if (!kind.seen) return errors;
  errors.missing = 0.08f;
  errors.exchanged = 0.02f;
  if (number % 6 == 0) errors.cut = Cut::Hips;
  return errors;
}

/// Somebody before a camera.
struct Take {
  FlatPerson person;
  const Clip* clip;
  int first, step;
  Pinhole camera;
};

FlatPose seen_of(const Take& take, int number, const DetectorErrors& errors, Rng& rng) {
  const Pose& pose = take.clip->motion.poses[static_cast<size_t>(take.first + number * take.step)];
  return detected(seen_flat(take.person, pose, take.camera), errors, rng);
}

Pinhole some_camera(Rng& rng) {
  ViewRange range;
  range.pitch = kFigurePitch;
  range.orthographic = 1;
  return random_view(Vec3::Zero(), range, rng);
}

/// Both sides alike, as any tool would have it.
BoneLengths both_sides(const BoneLengths& length) {
  BoneLengths mean;
  for (int b = 0; b < kFlatBoneCount; ++b)
    mean[b] = (length[b] + length[kFlatBoneMirror[static_cast<size_t>(b)]]) / 2;
  return mean;
}

/// As long as bones look in the poses, at most; 0 where they are not seen.
Proportions longest_looks(const FlatPose* poses, int count) {
  Proportions longest;
  longest.length.setZero();
  for (int i = 0; i < count; ++i) longest.length = longest.length.max(both_sides(seen_lengths(poses[i])));
  return longest;
}

Proportions estimated(const FlatPose* poses, const PoseLengths* told, int count) {
  ProportionEstimate estimate;
  for (int i = 0; i < count; ++i) estimate.push(poses[i], told[i]);
  return estimate.lengths();
}

Proportions known(const BoneLengths& length) {
  Proportions proportions;
  proportions.length = length;
  return proportions;
}

}  // namespace

ProportionFigures::ProportionFigures(const TrainingData& data, int cases) {
  const std::vector<FlatPerson> people = flat_people_of(data);
  const std::vector<ClipRun> runs = good_runs(data.clips, kShortestTrack, std::numeric_limits<int>::max());
  US_CHECK(!runs.empty(), "the data has no clip with ", kShortestTrack, " frames in a row to judge on");
  for (const SuiteKind& kind : kSuites) {
    Rng rng(kFigureSeed);
    const auto any_run = [&] { return runs[static_cast<size_t>(rng.below(static_cast<int>(runs.size())))]; };
    const auto take = [&](bool odd, const ClipRun& run) {
      const int step = std::min(kTrackStep, (run.count - 1) / (kTrack - 1));
      Take made{people[static_cast<size_t>(rng.below(static_cast<int>(people.size())))],
                &data.clips[static_cast<size_t>(run.clip)],
                run.first + rng.below(run.count - step * (kTrack - 1)), step, some_camera(rng)};
      if (odd) made.person = scaled_apart(made.person, random_scales(rng));
      return made;
    };
    Suite& suite = suites_.emplace_back();
    suite.name = kind.name;
    for (int i = 0; i < cases; ++i) {
      const DetectorErrors errors = errors_of(kind, i);
      const ClipRun run = any_run();
      ClipRun other = any_run();
      for (int tries = 0; other.clip == run.clip && tries < 20; ++tries) other = any_run();
      const Take source = take(kind.odd && i % 2 == 0, run), target = take(kind.odd, other);
      for (int k = 0; k < kTrack; ++k) suite.tracks.push_back(seen_of(source, k, errors, rng));
      for (int k = 0; k < kTrack; ++k) suite.tracks.push_back(seen_of(target, k, errors, rng));
      Take truth = source;
      truth.person = target.person;
      const float scale = source.camera.focal;  // pixels of a metre
      suite.cases.push_back({suite.tracks[suite.tracks.size() - 2 * kTrack], seen_of(truth, 0, {}, rng),
                             lengths_of(source.person) * scale, lengths_of(target.person) * scale});
    }
  }
}

namespace {

/// Means over cases.
struct Means {
  double oks = 0, bone_ratio = 0;
};

}  // namespace

Figures ProportionFigures::of(const ReadLengths& read) const {
  Figures figures;
  LimbTransfer limbs(false);
  for (const Suite& suite : suites_) {
    const std::vector<PoseLengths> told = read(suite.tracks);
    for (const int count : {1, kTrack}) {
      Means sum;
      for (size_t i = 0; i < suite.cases.size(); ++i) {
        const Case& one = suite.cases[i];
        const size_t at = i * 2 * kTrack, then = at + kTrack;
        const Proportions from = estimated(&suite.tracks[at], &told[at], count),
                          to = estimated(&suite.tracks[then], &told[then], count);
        sum.oks += keypoint_similarity(limbs.transfer(one.source, from, to), one.truth);
        sum.bone_ratio += bone_ratio_error(to.length, one.target_length);
      }
      const auto cases = static_cast<double>(suite.cases.size());
      const std::string of = std::string("_") + suite.name + "_" + std::to_string(count);
      figures.push_back({"oks" + of, sum.oks / cases});
      figures.push_back({"bone_ratio" + of, sum.bone_ratio / cases});
    }
  }
  return figures;
}

Figures ProportionFigures::baselines() const {
  Figures figures;
  LimbTransfer limbs(false);
  for (const Suite& suite : suites_) {
    std::array<double, 4> sum{};
    for (size_t i = 0; i < suite.cases.size(); ++i) {
      const Case& one = suite.cases[i];
      const FlatPose* const track = &suite.tracks[i * 2 * kTrack];
      const auto oks = [&](Proportions from, Proportions to) {
        const auto known = from.length > 1e-3f && to.length > 1e-3f;
        const BoneLengths ratio = (to.length / from.length.max(1e-3f)).max(1.0f / 3).min(3.0f);
        from.length = from.length.max(1e-3f);
        to.length = from.length * known.select(ratio, 1.0f);
        return keypoint_similarity(limbs.transfer(one.source, from, to), one.truth);
      };
      sum[0] += keypoint_similarity(one.source, one.truth);
      sum[1] += oks(known(one.source_length), known(one.target_length));
      sum[2] += oks(longest_looks(track, 1), longest_looks(track + kTrack, 1));
      sum[3] += oks(longest_looks(track, kTrack), longest_looks(track + kTrack, kTrack));
    }
    const auto cases = static_cast<double>(suite.cases.size());
    const std::array<const char*, 4> names = {"copy", "true_ratios", "one_frame", "longest_of_10"};
    for (size_t k = 0; k < names.size(); ++k)
      figures.push_back({std::string(names[k]) + "_" + suite.name, sum[k] / cases});
  }
  return figures;
}

}  // namespace understudy::training
