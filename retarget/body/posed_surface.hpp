// The surface of a person in one frame. Points are sampled in T-pose, and only those are posed.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "retarget/body/body.hpp"
#include "retarget/body/footwear.hpp"
#include "retarget/body/fused_surface.hpp"
#include "retarget/body/hand_poses.hpp"

namespace understudy {

/// Fingers that go from one pose to another, or stay.
struct HandMotion {
  std::array<HandAngles, 2> from = {HandAngles::Zero(), HandAngles::Zero()}, to = from;  ///< left, right
  float share = 0, step = 0;  ///< of the way: now, and more with each frame

  /// The angles of a frame; the next call is for the frame after it.
  std::array<HandAngles, 2> next();
};

/// What is changed of a body's T-pose surface; null: nothing.
struct SurfaceLook {
  const HandPoses* hand_poses = nullptr;  ///< with the body's hands and the angles in this frame
  const HandVertices* hands = nullptr;
  std::array<HandAngles, 2> angles = {HandAngles::Zero(), HandAngles::Zero()};
  const Shoes* shoes = nullptr;
  const UnevenSurface* uneven = nullptr;
};

/// The body and what the look names must outlive it.
class PosedSurface {
 public:
  PosedSurface(const ShapedBody& body, const Pose& pose, const SurfaceLook& look);

  const PosedSkeleton& truth() const { return truth_; }
  /// Points of some of the body's faces, with normals and the joint that each follows most.
  OrientedPoints sample(const SurfaceSampler& sampler, const Faces& faces, int count, Rng& rng);
  /// About `count` points of a hand (0 left, 1 right) and as much of the forearm, as the solid that it is.
  /// Nothing where the body has no face there.
  std::optional<SoftSolid> hand_solid(int side, int count, float softness, uint64_t seed);

 private:
  struct RestPoints {
    Points points, normals, offsets;
    RowMatrix weights;
  };
  /// A T-pose vertex and what the pose adds to it.
  struct Corner {
    Vec3 place, offset;
  };
  const Corner& corner(int vertex);
  RestPoints rest_points(const SurfaceSampler& sampler, const Faces& faces, int count, Rng& rng);

  const ShapedBody& body_;
  SurfaceLook look_;
  PosedSkeleton truth_;
  Eigen::VectorXf features_;
  std::optional<BentHands> hands_;
  std::vector<Corner> corners_;  // [V], those of is_known_: neighbouring points share them
  std::vector<char> is_known_;
};

}  // namespace understudy
