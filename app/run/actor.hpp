// People of a data folder who perform its motions before simulated cameras.
#pragma once

#include <memory>
#include <vector>

#include "retarget/body/data_folder.hpp"
#include "retarget/body/posed_surface.hpp"

namespace understudy::app {

/// Somebody in a motion, on the floor y = 0.
class Actor {
 public:
  Actor(ShapedBody body, std::vector<Pose> poses);

  size_t frames() const { return poses_.size(); }
  const ShapedBody& body() const { return *body_; }
  const std::vector<Pose>& poses() const { return poses_; }
  PosedSkeleton skeleton(size_t frame) const;
  /// In the next frame; after the last, in the one before.
  PosedSkeleton beside(size_t frame) const;
  /// Points drawn evenly on the skin, in no order.
  LabelledPoints surface(size_t frame, int count, Rng& rng) const;

  /// Fingers as they stay. `poses` must outlive this.
  void hold_hands(const HandPoses& poses, HandVertices hands, const std::array<HandAngles, 2>& angles);
  /// Other poses; stands on the floor again.
  void perform(std::vector<Pose> poses);
  /// Turned about the world's y axis, then moved.
  void move(float yaw, const Vec3& by);

 private:
  std::shared_ptr<const ShapedBody> body_;
  std::shared_ptr<const SurfaceSampler> sampler_;
  std::vector<Pose> poses_;
  const HandPoses* hand_poses_ = nullptr;
  HandVertices hands_;
  std::array<HandAngles, 2> angles_ = {HandAngles::Zero(), HandAngles::Zero()};
};

/// How near joints of two people come over all frames, metres.
float nearest_joints(const Actor& a, const Actor& b);

/// Hands out the people of a split.
class Cast {
 public:
  /// `body`: SMPL-format; empty: the split's own.
  explicit Cast(DataSplit split, const std::string& body = "");
  const std::vector<EvaluatedMotion>& motions() const { return split_.motions; }
  /// Number `person` of the people, every third dressed where there are such, with random fingers, in at most
  /// so many frames of a motion.
  Actor actor(size_t person, size_t motion, int frames, Rng& rng) const;
  /// The motions whose paths over so many frames are longest, the longest first.
  std::vector<size_t> longest_paths(int frames) const;

 private:
  DataSplit split_;
  Body body_;
  float template_leg_;
  std::unique_ptr<HandPoses> hand_poses_;  // null: no fingers
};

}  // namespace understudy::app
