// Hands that touch the body or each other do so on another body, too, online.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/body_girth.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Holds hands that are near the source's body at the same place of the target's, with the same gap, and
/// pushes hands and forearms out of it: by inverse kinematics of the arm, the hand keeps its world rotation.
///
/// The source's surface is taken to be the target's with the source's bone lengths, as thick around its bones
/// as its scans so far have shown (without scans: as a human is). So each place on one body has its place on
/// the other. Looks only back, memory is constant; no hand near, no change.
class HandContacts {
 public:
  /// weights [V, 22] of the target's T-pose vertices.
  void bind(const Mesh& target, const Joints& rest, const RowMatrix& weights);
  /// The source starts anew.
  void reset();
  /// The pose with its hands where they belong. source: the source's joints in this frame, world; girth: of
  /// its scan, where there is one; dt seconds since the frame before; local_a: the source's local rotations
  /// where they are not the pose's, whose limbs were placed elsewhere.
  Pose push(const Pose& pose, const Joints& source, const std::optional<BodyGirth>& girth, float dt,
            const Rotations* local_a = nullptr);
  /// How far each wrist is moved in the last frame, metres: left, right.
  std::array<float, 2> moved() const { return {offset_[0].norm(), offset_[1].norm()}; }

 private:
  struct Body;   // the target's surface, in samples
  struct Scene;  // one frame of both bodies
  void learn(const Joints& source, const std::optional<BodyGirth>& girth);
  Points source_rest(const Joints& rest_a) const;
  std::vector<int> near(const Scene& scene, int side, const std::vector<int>& actors) const;
  Vec3 pull(const Scene& scene, const std::vector<int>& hand, const std::vector<int>& near,
            float& held) const;
  Vec3 push_out(const Scene& scene, const std::vector<int>& actors, const std::vector<int>& near) const;
  std::array<Vec3, 2> wanted(Scene& scene) const;

  std::shared_ptr<const Body> body_;
  RunningGirth girth_;
  Eigen::Array<float, kJointCount, 1> lengths_ = Eigen::Array<float, kJointCount, 1>::Zero();
  float frames_ = 0;
  std::array<Vec3, 2> offset_ = {Vec3::Zero(), Vec3::Zero()};  // of each wrist, in the chest's axes
};

}  // namespace understudy
