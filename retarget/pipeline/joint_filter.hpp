// Causal repair and smoothing of extracted joints: sides exchanged back, noise out, bones of one length.
#pragma once

#include <array>

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/running_median.hpp"

namespace understudy {

struct JointFilterOptions {
  /// exchange left and right where the last frames say so and the frame's evidence is weak
  bool repair_swaps = true;
  bool smooth = true;          ///< constant-velocity Kalman filter of each joint and of each seen rotation
  bool fix_lengths = true;     ///< pull each bone to the running median of its length
  float noise_m = 0.004f;      ///< standard deviation of an extracted coordinate at confidence 1
  float weak_noise_m = 0.1f;   ///< the same at confidence 0
  float acceleration = 12.0f;  ///< m/s^2, how hard joints are expected to accelerate relative to the pelvis
  float root_acceleration = 14.0f;  ///< m/s^2, the same of the pelvis in the world
  float turn_noise = 0.025f;        ///< standard deviation of a seen rotation at confidence 1, radians
  float weak_turn_noise = 0.25f;    ///< the same at confidence 0
  float turn_acceleration = 40.0f;  ///< rad/s^2, how hard bones are expected to begin to turn
  float swap_confidence = 0.75f;    ///< sides of limbs whose mean confidence is above this are believed
  int swap_patience = 10;           ///< after this many repaired frames in a row the frame is believed
  int length_window = 150;          ///< frames that the lengths' medians are over
};

/// Frame by frame with state; looks only back. Memory is bounded.
class JointFilter {
 public:
  explicit JointFilter(const JointFilterOptions& options = {});
  void reset();
  /// The frame's joints and seen rotations repaired and smoothed, dt seconds after the one before.
  /// Confidences go with their joints. Where a swap was repaired there are no seen rotations, since the sides
  /// of what was seen are unknown. What is exact stays as it is.
  Extraction push(const Extraction& raw, float dt);
  /// Whether the last push() exchanged sides.
  bool repaired() const { return repaired_; }
  /// Medians of the source's bone lengths so far, sides averaged, metres; the pelvis' is 0.
  Eigen::Array<float, kJointCount, 1> lengths() const;

 private:
  /// The covariance of a value and its speed, the same for x, y and z.
  struct Covariance {
    float pp = 0, pv = 0, vv = 0;
    void predict(float dt, float acceleration);
    /// What share of an innovation (its squared length) goes into the value, and into its speed.
    std::array<float, 2> correct(float innovation, float noise);
  };
  struct Track {
    Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
    Covariance covariance;
  };
  struct Turn {
    Mat3 rotation = Mat3::Identity();
    Vec3 velocity = Vec3::Zero();  // radians/s, world axes
    Covariance covariance;
  };
  float noise(float confidence, float sure, float weak) const;
  void repair_swaps(Extraction& frame);
  void smooth(Extraction& frame, float dt);
  void smooth_turns(Extraction& frame, float dt);
  void fix_lengths(Extraction& frame);

  JointFilterOptions options_;
  std::array<Track, kJointCount> tracks_;  // the pelvis in the world, the others relative to it
  std::array<Turn, kJointCount> turns_;    // of what was seen, world
  bool turning_ = false;                   // turns_ hold those of the frame before
  std::array<RunningMedian, kJointCount> lengths_;
  Joints last_ = Joints::Zero(), before_last_ = Joints::Zero();
  int frames_ = 0, swaps_in_a_row_ = 0;
  bool repaired_ = false;
};

}  // namespace understudy
