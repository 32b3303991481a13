// The camera in which a body lies on a person in a picture.
#pragma once

#include "retarget/pose2d/body_view.hpp"

namespace understudy {

struct CameraFitOptions {
  float focal = 1000;  ///< pixels, kept
  Vec2 centre = Vec2::Zero();
  float pitch = 0;  ///< radians, kept
  bool orthographic = false;
};

struct CameraFit {
  Pinhole camera;
  float error = 0;  ///< root of the mean squared distance of the points that count, pixels
};

/// Least squares over the yaw, the distance (orthographic: the focal length) and the shift across the view,
/// of the first 15 points of BODY_25 that the reference has, weighed by their confidence: Gauss-Newton from
/// twelve headings, with steps that are taken back where they do not help. Throws Error when fewer than four
/// of the points are there.
CameraFit fit_camera(const BodyPlaces& places, const FlatPose& reference, const CameraFitOptions& options);

}  // namespace understudy
