// How much of a sighting a point follows: a small recurrent network.
#pragma once

#include <array>

#include <Eigen/Core>

namespace understudy {

/// What the gains of a point depend on, see PointFilter: how far the sighting is off, whether to where the
/// last one was, to where the point goes, and to where the shown place lags; how fast the point goes; how far
/// the shown place is behind; how large the noise is of the person; how far all points were off last; how
/// long the point is seen; the interval.
constexpr int kGainFeatures = 10, kGainHidden = 12;
/// Shares of what a sighting is off that place and velocity follow, of the way from the shown place to the
/// place that is gone, and of the velocity that it is gone with anyway.
constexpr int kGains = 4;
constexpr int kGainGates = 3;  ///< reset, update, new
constexpr int kGainNumbers =
    kGainGates * kGainHidden * (kGainFeatures + kGainHidden + 2) + (kGainHidden + 1) * kGains;

using GainFeatures = Eigen::Matrix<float, kGainFeatures, 1>;
using GainMemory = Eigen::Matrix<float, kGainHidden, 1>;

/// A gated recurrent unit (Cho et al. 2014, as LibTorch has it), a layer, a logistic function.
class PointGains {
 public:
  /// Weights of the unit from features and from memory, its biases of both, the layer's weights and biases;
  /// row by row.
  explicit PointGains(const std::array<float, kGainNumbers>& numbers);
  /// Fitted by `understudy train points`, which writes the numbers as point_gains.inc has them.
  static const PointGains& fitted();
  static const std::array<float, kGainNumbers>& fitted_numbers();

  /// Each between 0 and 1.
  Eigen::Vector4f gains(const GainFeatures& features, GainMemory& memory) const;

 private:
  static constexpr int kAll = kGainGates * kGainHidden;
  using Gates = Eigen::Matrix<float, kAll, 1>;
  Eigen::Matrix<float, kAll, kGainFeatures> from_features_;
  Eigen::Matrix<float, kAll, kGainHidden> from_memory_;
  Gates features_bias_, memory_bias_;
  Eigen::Matrix<float, kGains, kGainHidden> out_;
  Eigen::Vector4f out_bias_;
};

}  // namespace understudy
