// How good lengths read off 2D poses are, on people and motions that nothing was learned from.
#pragma once

#include <functional>
#include <vector>

#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// What is read off each of the poses.
using ReadLengths = std::function<std::vector<PoseLengths>(const std::vector<FlatPose>& poses)>;

/// Somebody performs, and somebody else, known from another motion before another camera, is to do the same:
/// the same local rotations seen by the same camera are the truth. `real`: people of the split; `odd`: with
/// bones scaled apart, the performer in every other case; `noisy`: odd, points 15 mm off along each axis;
/// `seen`: noisy, 8 % of points missing, 2 % of limbs with exchanged sides, one case in six cut at the hips.
class ProportionFigures {
 public:
  /// Throws Error when the data has no clip with 20 frames in a row.
  ProportionFigures(const TrainingData& data, int cases);
  /// oks and bone_ratio with lengths from one pose of each, and from ten over two seconds.
  Figures of(const ReadLengths& read) const;
  /// oks of the source as it is, of the true ratios, and of lengths as they look in one pose and, the
  /// longest, in ten: what any reader stands between.
  Figures baselines() const;

  static constexpr int kTrack = 10;

 private:
  struct Case {
    FlatPose source, truth;
    BoneLengths source_length, target_length;  // true ones
  };
  struct Suite {
    const char* name;
    std::vector<Case> cases;
    std::vector<FlatPose> tracks;  // of each case kTrack poses of the source, then of the target
  };
  std::vector<Suite> suites_;
};

}  // namespace understudy::training
