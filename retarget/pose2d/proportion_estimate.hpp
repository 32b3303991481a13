// A person's lengths from all poses of theirs that were seen so far.
#pragma once

#include <array>
#include <cstdint>

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy {

/// Online, of constant memory. What each pose tells counts by its doubt; both sides of a person are alike; no
/// bone is shorter than it was seen, but for the few frames in which a detector saw it longest.
class ProportionEstimate {
 public:
  void reset() { *this = ProportionEstimate(); }
  /// told: of this pose, by a LengthReader.
  void push(const FlatPose& pose, const PoseLengths& told);
  /// Throws Error before the first pose.
  Proportions lengths() const;
  int poses() const { return poses_; }

 private:
  /// How often a bone was seen how long: logarithms, in steps of 3 %, from a 1000th pixel.
  struct Seen {
    static constexpr int kBins = 640;
    std::array<uint32_t, kBins> counts{};
    uint32_t all = 0;
    void add(float length);
    /// Of the longest, all but the first in fifty; 0 when it was never seen.
    float longest() const;
  };
  std::array<Seen, kFlatBoneCount> seen_;
  Eigen::Array<double, kFlatBoneCount, 1> sum_ = Eigen::Array<double, kFlatBoneCount, 1>::Zero(),
                                          weight_ = Eigen::Array<double, kFlatBoneCount, 1>::Zero();
  int poses_ = 0;
};

}  // namespace understudy
