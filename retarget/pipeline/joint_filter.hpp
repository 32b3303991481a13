// Causal repair and smoothing of extracted joints: sides exchanged back, noise out, bones of one length.
#pragma once

#include <array>

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/running_median.hpp"

namespace understudy {

struct JointFilterOptions {
  bool repair_swaps =
      true;  ///< exchange left and right where the last frames say so and the frame's evidence is weak
  bool smooth = true;          ///< constant-velocity Kalman filter of each joint
  bool fix_lengths = true;     ///< pull each bone to the running median of its length
  float noise_m = 0.012f;      ///< standard deviation of an extracted coordinate at confidence 1
  float weak_noise_m = 0.06f;  ///< the same at confidence 0
  float acceleration = 12.0f;  ///< m/s^2, how hard joints are expected to accelerate relative to the pelvis
  float root_acceleration = 6.0f;  ///< m/s^2, the same of the pelvis
  float swap_confidence = 0.75f;   ///< sides of limbs whose mean confidence is above this are believed
  int swap_patience = 10;          ///< after this many repaired frames in a row the frame is believed
  int length_window = 150;         ///< frames that the lengths' medians are over
};

/// Frame by frame with state; looks only back. Memory is bounded.
class JointFilter {
 public:
  explicit JointFilter(const JointFilterOptions& options = {});
  void reset();
  /// The frame's joints repaired, dt seconds after the one before. Confidence is passed on; seen rotations
  /// are passed on unless a swap was repaired, since the sides of what was seen are then unknown. What is
  /// exact stays as it is.
  Extraction push(const Extraction& raw, float dt);
  /// Whether the last push() exchanged sides.
  bool repaired() const { return repaired_; }
  /// Medians of the source's bone lengths so far, sides averaged, metres; the pelvis' is 0.
  Eigen::Array<float, kJointCount, 1> lengths() const;

 private:
  struct Track {
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
    float pp = 0, pv = 0, vv = 0;  // covariance, the same for x, y, z
  };
  void predict(float dt);
  void correct(Track& track, const Vec3& measured, float noise) const;
  void repair_swaps(Extraction& frame);
  void smooth(Extraction& frame, float dt);
  void fix_lengths(Extraction& frame);

  JointFilterOptions options_;
  std::array<Track, kJointCount> tracks_;  // the pelvis in the world, the others relative to it
  std::array<RunningMedian, kJointCount> lengths_;
  Joints last_ = Joints::Zero(), before_last_ = Joints::Zero();
  int frames_ = 0, swaps_in_a_row_ = 0;
  bool repaired_ = false;
};

}  // namespace understudy
