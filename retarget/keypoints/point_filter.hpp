// One point of a picture over time: a Kalman filter of constant velocity.
#pragma once

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// Where a point is and how it moves, seen with errors that depend on the confidence. State x, v with white
/// noise of the acceleration from one frame to the next (Bar-Shalom, Li, Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, section 6.3.2); both axes alike, so one covariance serves
/// both. The noise of the acceleration grows with how far sightings are from what was expected lately: calm
/// where the point rests, quick where it moves.
class PointFilter {
 public:
  /// Lengths in pixels; size: of the whole person.
  struct Noise {
    float size = 1;
    float smoothing = 1;  ///< 0: the point is where it was seen
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
  int outliers() const { return outliers_; }
  void count_outlier() { ++outliers_; }
  void reset() { *this = PointFilter(); }

 private:
  Vec2 show(float dt, const Noise& noise);
  Vec2 x_ = Vec2::Zero(), v_ = Vec2::Zero(), shown_ = Vec2::Zero();
  float pxx_ = 0, pxv_ = 0, pvv_ = 0;  // covariance
  float surprise_ = 1;                 // mean squared innovation over its expected square
  float confidence_ = 0, unseen_ = 0;
  int outliers_ = 0;  // in a row
  bool is_alive_ = false;
};

}  // namespace understudy
