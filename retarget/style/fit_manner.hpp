// A manner fitted to recordings of two manners of moving: nothing is paired, nothing is learned by a network.
#pragma once

#include <string>
#include <vector>

#include "retarget/style/manner.hpp"

namespace understudy {

/// Which joints a manner is fitted to: "all" but feet and hands; "trunk-and-limbs", without wrists;
/// "upper-body", without legs, too: where a camera does not see them well enough to learn from. Throws Error
/// for others.
std::vector<int> fitted_joints(const std::string& which);

/// What recordings of one manner tell: means over clips, each counts alike.
class MannerSample {
 public:
  /// `smooth_frames`: standard deviation of the Gaussian that the recordings go through, in frames of 30 a
  /// second, so that the noise of one capture is not taken for the life of another.
  explicit MannerSample(std::vector<int> joints, double smooth_frames = 1.5)
      : joints_(std::move(joints)), smooth_s_(smooth_frames / 30) {}
  /// Frames of one person. Clips of fewer than 10 frames tell nothing and are left out.
  void add(const std::vector<StyleFrame>& clip);
  int clips() const { return clips_; }
  const std::vector<int>& joints() const { return joints_; }
  /// [3 joints]: means of the rotation vectors, radians.
  Eigen::VectorXf posture() const { return postures_ / static_cast<float>(clips_); }
  /// [3 joints, 3 joints] of the movements (JointMovement), radians^2.
  Eigen::MatrixXf covariance() const { return products_ / static_cast<float>(clips_); }

 private:
  std::vector<int> joints_;
  double smooth_s_;
  int clips_ = 0;
  Eigen::VectorXf postures_;  // sums over clips
  Eigen::MatrixXf products_;
};

/// The manner that makes the movements of `from` those of `to`: postures differ as the means do, and
/// movements go through the linear map that takes their covariance to the other's and changes them least: the
/// optimal transport between two Gaussians, A^-1/2 (A^1/2 B A^1/2)^1/2 A^-1/2 (Knott and Smith
/// 1984). Correlations between joints become those of `to`, which gains of single joints cannot do.
/// Both only as far as a style's file holds them; what is cut of a posture is logged.
/// coupled false: a gain of each joint by itself. Both samples have the same joints. Throws Error where a
/// sample has fewer than two clips.
Manner fit_manner(const MannerSample& from, const MannerSample& to, bool coupled = true);

}  // namespace understudy
