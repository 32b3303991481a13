// Walking: where the body is and where each foot stands or swings, at any time.
#pragma once

#include <vector>

#include "retarget/creature/puppet.hpp"

namespace understudy {

struct GaitStyle {
  float period = 1.2f;        ///< seconds from one step of a foot to its next
  float down = 0.65f;         ///< share of it that a foot is on the floor
  float speed = 0.2f;         ///< metres a second along the path
  float turning = 0;          ///< radians a second, to the left
  float lift = 0.05f;         ///< metres, how high a foot swings
  std::vector<float> phases;  ///< [feet] share of the period by which each is ahead
};

class Gait {
 public:
  /// A foot: its contact's place, how it is turned, and how far its swing is, 0 .. 1 (0: it stands).
  struct Step {
    Vec3 place;
    Mat3 facing;
    float swing;
  };
  /// feet: where each touches the floor at rest.
  Gait(std::vector<Vec3> feet, GaitStyle style) : feet_(std::move(feet)), style_(std::move(style)) {}

  /// Takes the body at rest to where it is then, without its bobbing; nowhere at 0 seconds.
  RigidMotion body(float seconds) const;
  Step step(size_t foot, float seconds) const;

 private:
  std::vector<Vec3> feet_;
  GaitStyle style_;
};

/// Poses the feet of a walk, each by Puppet::plant; the trunk must have its pose. In its swing a foot tips
/// its toes down by up to `tip` radians.
void plant_feet(Puppet& puppet, const std::vector<Limb>& limbs, const Gait& gait, float seconds, float tip);
/// The contacts of limbs.
std::vector<Vec3> contacts_of(const std::vector<Limb>& limbs);

}  // namespace understudy
