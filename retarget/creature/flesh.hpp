// What moves in a body besides its bones: breath, and flesh that wobbles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// Gives the rest surface of a living body at any time, before it is posed.
class Flesh {
 public:
  /// breathing: joints whose flesh breathes.
  Flesh(const Rig& rig, const std::vector<std::string>& breathing, uint64_t seed);
  /// [V, 3] metres
  Points at(float seconds) const;

 private:
  struct Ripple {
    Vec3 way, across;  // displacement; the phase's change from place to place, radians a metre
    float pace, phase;
  };
  const Points rest_;
  Points breath_;             // [V, 3] how far a full breath moves each point
  Eigen::VectorXf softness_;  // [V] 0 at bones near the skin .. 1 in thick flesh
  std::vector<Ripple> ripples_;
  float breaths_;  // a second
  float begin_;    // phase of the breath, radians
};

}  // namespace understudy
