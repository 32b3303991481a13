// A lifted person's place in the world: metres, sideways way, depth, floor.
#pragma once

#include <optional>

#include "retarget/pipeline/lifter.hpp"

namespace understudy {

/// A person lifted out of one picture, before anybody knows how large and where they are.
struct LiftedPose {
  Joints joints = Joints::Zero();       ///< around the middle of the hips; right, up, to the eye; of `size`
  Confidence off = Confidence::Zero();  ///< how far each is expected to be off, the same unit
  std::optional<Rotations> turns;       ///< world rotations in the same axes
  float pitch = 0;                      ///< sine of how far the camera looks down, by this pose
  Vec2 origin = Vec2::Zero();           ///< where the middle of the hips is seen, pixels
  bool has_hips = true;                 ///< false: it is not, the seen points tell
  float size = 1;                       ///< pixels
};

/// Online. The camera keeps still and is not rolled; what a picture does not tell of it is in LiftView.
class LiftedPath {
 public:
  /// Throws Error as Lifter::reset.
  explicit LiftedPath(const LiftView& view);
  /// dt: seconds since the frame before. See Lifter::push.
  Extraction push(const LiftedPose& lifted, const FlatPose& pose, float dt);

 private:
  float metres_a_pixel(const LiftedPose& lifted, float dt);
  Mat3 from_camera(float told);
  void stand(Joints& joints, float dt);

  LiftView view_;
  float focal_;                // pixels
  float log_stature_ = 0;      // of the person in the picture, pixels
  float floor_ = 0;            // how far the camera is above it, metres
  Vec3 first_ = Vec3::Zero();  // the middle of the hips when first seen, before the camera
  double pitch_ = 0;           // mean of the sines that poses told
  int poses_ = 0;
  bool started_ = false;
};

/// Sole to crown of a body with these joints, of their unit, whatever the pose: from its legs, spine and
/// neck, as in a mean human.
float stature_of(const Joints& joints);

}  // namespace understudy
