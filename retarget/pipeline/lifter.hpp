// From a person in a picture to a skeleton in space, as the pipeline sees it: abstract, so that no user of it
// needs LibTorch.
#pragma once

#include <optional>
#include <string>

#include "retarget/keypoints/keypoint_track.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

constexpr float kUsualStature_m = 1.7f, kUsualFov_deg = 50;

/// What a picture does not tell of itself.
struct LiftView {
  Canvas canvas;                      ///< size of the picture, known
  float stature_m = kUsualStature_m;  ///< of the person, sole to crown
  float fov_deg = kUsualFov_deg;      ///< vertical angle that the picture takes of the camera's view
  std::optional<float> pitch_deg;     ///< how far the camera looks down; none: as the poses so far tell
};

/// One person's 2D poses in, skeletons out, frame by frame, with state: looks only back. One thread at a
/// time.
class Lifter : public Remembering {
 public:
  /// Forgets the person. Throws Error when the canvas is unknown, or stature or angle are nobody's.
  virtual void reset(const LiftView& view) = 0;
  /// The skeleton of a pose from KeypointFilter, dt seconds after the one before: world, metres, y up, floor
  /// at 0, before a still camera that looks along -z and down: who faces it faces +z, and who walks to the
  /// picture's right walks to +x. Sideways the pelvis goes as in the picture, in depth by how large the
  /// person is; world x and z of 0 are those of the first frame's pelvis. Joints that are not seen are made
  /// up; the confidence (confidence_for) tells how far joints may be off around the pelvis, and visibility
  /// which are seen. `exact` is false. Throws Error when fewer than three of BODY_25's first 15 points are
  /// seen, before reset(), for a dt that is not above 0, and when the answer is not finite.
  virtual Extraction push(const FlatPose& pose, float dt) = 0;
  virtual std::string name() const = 0;
};

}  // namespace understudy
