// One point of a picture over time: place and velocity follow sightings by fitted gains.
#pragma once

#include "retarget/keypoints/flat_pose.hpp"
#include "retarget/keypoints/point_gains.hpp"

namespace understudy {

/// Where a point is and how it moves, seen with errors that depend on the confidence: a Kalman filter of
/// constant velocity (Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation,
/// 2001, section 6.3.2) and a low-pass after it, whose gains a small network tells in every frame from where
/// to and how far sightings were off (as KalmanNet, Revach et al., IEEE TSP 2022, learns the gain): those
/// that are off to one side again and again are movement, off to any side they are jitter.
class PointFilter {
 public:
  /// Error of a sighting, of a person's size, that an outlier must be beyond anyway.
  static constexpr float kSightingError = 0.008f;
  // What the gains were fitted with.
  static constexpr float kCoasting = 0.15f;     ///< seconds: the velocity of what is not seen decays
  static constexpr float kForgottenUnseen = 3;  ///< a second of missing takes so many of age
  static constexpr float kAgeScale = 6;         ///< per second
  static constexpr float kUsualRate = 30;       ///< frames a second
  /// Lengths in pixels.
  struct Noise {
    float size = 1;   ///< of the whole person
    float sigma = 1;  ///< standard deviation of a sighting of confidence 1; 0: points are where they are seen
    float unrest = 0;  ///< mean unrest() of the body's points
    float gap_s = 0.5f;
  };

  bool is_alive() const { return is_alive_; }
  /// Where it will be dt seconds after the last step; alive only.
  Vec2 expected(float dt) const;
  /// Whether a sighting there, dt after the last step, is too far off to be the same point.
  bool is_outlier(const Vec2& seen, float dt, const Noise& noise) const;
  /// The point is seen there; the place to show.
  Vec2 see(const Vec2& seen, float confidence, float dt, const Noise& noise);
  /// The point is missing: carried on, slowing down, for gap_s. False when it is given up.
  bool miss(float dt, const Noise& noise);
  Vec2 place() const { return shown_; }  ///< what to show
  /// Of a missing point: falls to 0 over gap_s.
  float confidence(const Noise& noise) const;
  /// How far the last sighting was off, of its noise; logarithm of it and 1.
  float unrest() const;
  int outliers() const { return outliers_; }
  void count_outlier() { ++outliers_; }
  void reset() { *this = PointFilter(); }

 private:
  Vec2 show(const Vec2& way);
  GainFeatures features(const Vec2& off, float sigma, float dt, const Noise& noise) const;

  Vec2 x_ = Vec2::Zero(), v_ = Vec2::Zero(), shown_ = Vec2::Zero();
  Vec2 off_ = Vec2::Zero();  // the last sighting, of sigma
  GainMemory memory_ = GainMemory::Zero();
  float off_square_ = 1;  // mean of half its square lately: 1 where sightings are off by their noise alone
  float show_gain_ = 1, carry_gain_ = 0;  // at the last sighting
  float age_ = 0;                         // seconds that it is seen, less so where it was missing
  float confidence_ = 0, unseen_ = 0;
  int outliers_ = 0;  // in a row
  bool is_alive_ = false;
};

}  // namespace understudy
