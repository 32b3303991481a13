// What judges of style see of a motion: numbers that move, of the joints that a capture knows well.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The joints that are judged: trunk, neck, head and arms down to the elbows; with `legs` hips and knees.
/// Never what a depth camera sees worst, ankles, toes, wrists and hands.
std::vector<int> judged_joints(bool legs);

/// [frames, 3 judged joints] rotation vectors, radians; the pelvis' without its heading.
RowMatrix judged_channels(const std::vector<Rotations>& local, bool legs);

/// Those of the same motion seen in a mirror.
RowMatrix mirrored_channels(const RowMatrix& channels, bool legs);

/// Which channels move, in their order: whose spread (standard deviation) in a clip is `least` radians on
/// average, or whose mirror's is. Below that a capture shows its noise.
std::vector<int> moving_channels(const std::vector<RowMatrix>& clips, bool legs, float least = 0.012f);

/// Frames of kWordRate, the Gaussian that judged motions and those judges learn from go through.
constexpr double kJudgedSmooth = 1.5;

/// Frames that every clip has when its coordination is judged.
constexpr int kCoordinationFrames = 90;

/// [frames, channels] as [kCoordinationFrames, channels], each channel less its mean and over its spread:
/// neither an offset nor a gain (but 0) of a channel, nor the clip's rate changes it.
RowMatrix coordination_of(const RowMatrix& channels);

/// The rows of a part of a clip, `first` .. `first + length` in frames, at `count` times from its beginning
/// to its end, in between straight.
RowMatrix resampled(const RowMatrix& rows, float first, float length, int count);

}  // namespace understudy
