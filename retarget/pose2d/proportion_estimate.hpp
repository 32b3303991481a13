// A person's lengths from all poses of theirs that were seen so far.
#pragma once

#include <array>
#include <cstdint>

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy {

/// Online, of constant memory. What each pose tells counts by its doubt; both sides of a person are alike;
/// the longer a bone is seen in any pose, the longer it is, but for what detectors see too long.
class ProportionEstimate {
 public:
  void reset() { *this = ProportionEstimate(); }
  /// told: of this pose, by a LengthReader.
  void push(const FlatPose& pose, const PoseLengths& told);
  /// Throws Error before the first pose.
  Proportions lengths() const;
  int poses() const { return poses_; }

 private:
  /// How often a bone was seen how long, on either side: logarithms, in steps of 3 %, from a 1000th pixel.
  struct Seen {
    static constexpr int kBins = 640;
    std::array<uint32_t, kBins> counts{};
    uint32_t all = 0;
    int highest = 0;  ///< bin that counts anything
    static int bin_of(double length);
    void add(float length);
    /// Of the longest, all but the first in fifty.
    double longest() const;
    /// Logarithm of the chance that a bone of this length was never seen longer, where detectors see lengths
    /// wrong by `jitter` (standard deviation), pixels.
    double log_chance(double length, double jitter) const;
  };
  /// Natural logarithm of pixels, and its standard deviation.
  struct LogLength {
    double mean, doubt;
  };
  LogLength log_length(int bone, double jitter) const;

  std::array<Seen, kFlatBoneCount> seen_;
  Eigen::Array<double, kFlatBoneCount, 1> sum_ = Eigen::Array<double, kFlatBoneCount, 1>::Zero(),
                                          weight_ = Eigen::Array<double, kFlatBoneCount, 1>::Zero();
  int poses_ = 0;
};

}  // namespace understudy
