// A rig that is posed joint by joint, by name, with legs that reach for places.
#pragma once

#include <string>
#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

constexpr float from_degrees(float degrees) {
  return degrees * kPi / 180;
}
/// A wave of period `period` seconds, -1 .. 1; `phase` in periods.
float wave(float seconds, float period, float phase = 0);
/// Visits the values one after the other, equally long each, and begins again every `period` seconds; eases
/// in and out of each.
float visiting(float seconds, float period, const std::vector<float>& values);

/// A limb that bends in one plane: a ball joint, one or two hinges of the same axis, and the point that it
/// reaches with, in that plane at rest.
struct Limb {
  std::vector<int> joints;      ///< ball, hinge, perhaps another hinge; parent first
  int paw = -1;                 ///< the joint at the end, if there is one: turned apart from the limb
  Vec3 end = Vec3::Zero();      ///< what reaches, at rest, world: where the paw joint is, or a tip
  Vec3 contact = Vec3::Zero();  ///< where it touches the floor, at rest
};

class Puppet {
 public:
  /// The rig must outlive the puppet.
  explicit Puppet(const Rig& rig) : pose(rest_pose(rig)), rig_(rig) {}
  RigPose pose;

  const Rig& rig() const { return rig_; }
  int joint(const std::string& name) const;  ///< throws Error for an unknown name
  Vec3 rest(const std::string& name) const { return rig_.joints[static_cast<size_t>(joint(name))].rest; }
  /// Turns a joint further, about an axis of its bone at rest, in radians.
  void turn(const std::string& name, const Vec3& axis, float angle);
  /// A hinge about its axis.
  void turn(const std::string& name, float angle);
  void slide(const std::string& name, float metres);
  /// Where a joint takes what it carries, from rest.
  RigidMotion bone(int joint) const;
  /// Bends the limb so that its end is at `target`, with the last of its bones turned by `pitch` against how
  /// the trunk would carry it. Short of the target where the limb is too short.
  void reach(const Limb& limb, const Vec3& target, float pitch = 0);
  /// Puts a paw at `place` (where its contact is to be) facing as `facing` says, the limb behind it.
  void plant(const Limb& limb, const Vec3& place, const Mat3& facing, float pitch = 0);

 private:
  const Rig& rig_;
};

/// The limb of these joints of the rig (see Limb). With `paw` it ends there; without, at the lowest point of
/// the last joint's own skin.
Limb limb_of(const Rig& rig, const std::vector<std::string>& joints, const std::string& paw = "");
/// The largest side of the box about the rig at rest, metres.
float size_of(const Rig& rig);

}  // namespace understudy
