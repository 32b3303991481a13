// A rig of simulated depth cameras: what time of flight and structured light leave of a surface's points.
#pragma once

#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// One camera. Noise after Khoshelham and Elberink, "Accuracy and Resolution of Kinect Depth Data" (Sensors
/// 2012, eq. 8 to 10): both it and the steps of a structured-light depth grow with its square.
struct DepthCamera {
  Vec3 eye = Vec3::Zero(), at = Vec3::UnitZ();  ///< looks from and at, metres
  float noise =
      0;  ///< standard deviation along the ray at one metre that grows with distance squared, metres
  float floor_noise = 0.001f;    ///< the part of it that does not grow, metres
  float step = 0;                ///< of a depth at one metre, grows with distance squared; 0: none
  float flying = 0;              ///< share of points at edges that lie somewhere behind them
  Mat3 turn = Mat3::Identity();  ///< misaligned about `at`
  Vec3 shift = Vec3::Zero();     ///< and by so much, metres
  float late = 0;                ///< share of the way to the frame beside that it sees people at
  float widest = 0;  ///< tangent of half its field of view, across and up; 0: it sees what is behind it, too
};

/// What a sensor loses on black cloth and on hair, the same places of the body in every frame.
struct DarkCloth {
  int group = -1;             ///< number of a group of parts; -1: nothing is black
  bool is_hair_lost = false;  ///< but for a little
  float left = 0.2f;          ///< share of points that is returned there
  float edge = 0;             ///< patches are where a wave of the place is above it, -1 all .. 1 nothing
  Vec3 wave = Vec3::Zero();   ///< radians a metre
};

/// Of most people nothing.
DarkCloth random_dark_cloth(Rng& rng);

struct DepthRig {
  std::vector<DepthCamera> cameras;
  DarkCloth dark;
};

/// Where a rig stands: about a place that all its cameras look at, so many metres away.
struct RigPlace {
  int cameras = 1;
  Vec3 at = Vec3::Zero();
  float nearest = 1, farthest = 4;
};

/// Alone, a camera is aligned and in time; of several each is off by up to 3 cm, 1 degree and 0.45 of a frame
/// (30 ms of 1/15 s). Some rigs stand all around, others on one side.
DepthRig random_depth_rig(const RigPlace& place, Rng& rng);
/// The same of 1 to 10 cameras about somebody, 1 to 4.5 m away.
DepthRig random_depth_rig(const PosedSkeleton& first, Rng& rng);

/// A surface before cameras.
struct SeenSurface {
  Points now, beside;           ///< [N, 3] metres: in this frame and in the one beside it
  std::vector<float> returned;  ///< [N] share of what a sensor gets back of a point: little of black cloth
};
/// Of a person. `beside`: the same person in a frame beside this one; `truth` itself where there is none.
SeenSurface surface_to_see(const LabelledPoints& cloud, const DarkCloth& dark, const PosedSkeleton& truth,
                           const PosedSkeleton& beside);

/// What a camera has of one point of a surface.
struct DepthReading {
  int row;
  Vec3 place;        ///< metres
  float behind = 0;  ///< the point, behind whose edge it flies, metres
  /// Whether it is so far behind that it is no longer on what it is read of.
  bool flies() const { return behind > 0.04f; }
};
/// Each point as one of the cameras that see it measures it, in the surface's order; those nobody sees are
/// left out.
std::vector<DepthReading> depth_readings(const SeenSurface& surface, const std::vector<DepthCamera>& cameras,
                                         Rng& rng);

/// A person's cloud as the rig has it, unless fewer than 200 points would be left. What flies is on no part.
void see_with_depth_cameras(LabelledPoints& cloud, const DepthRig& rig, const PosedSkeleton& truth,
                            const PosedSkeleton& beside, Rng& rng);

}  // namespace understudy
