// A creature described as a table: its joints and the pieces of its body, and the rig made of them.
#pragma once

#include <string>
#include <vector>

#include "retarget/creature/solid_part.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

/// A creature in its rest pose: floor y = 0, facing +z, about 1 to 2 long; `scale` makes metres of it.
class CreaturePlan {
 public:
  /// Parents come first; the first joint has no parent (""), and is Free. Gives its number.
  int joint(const std::string& name, const std::string& parent, JointKind kind, const Vec3& rest,
            const Vec3& axis = Vec3::UnitX());
  /// Adds a piece of the bone of this name. `blend` < 0: as softly as the piece itself proposes.
  SolidPart& add(const std::string& name, SolidPart part, float blend = -1);
  /// Takes the piece away from all that was added before.
  SolidPart& carve(const std::string& name, SolidPart part, float blend = 0.01f);
  /// Throws Error where there is none of this name.
  int number(const std::string& name) const;
  const Vec3& at(const std::string& name) const { return joints[static_cast<size_t>(number(name))].rest; }

  std::vector<RigJoint> joints;
  std::vector<SolidPart> parts;
  float scale = 1;          ///< metres in one unit of the plan
  bool mirrored = true;     ///< its own mirror image in x = 0
  bool machine = false;     ///< each vertex hangs on one bone
  float softness = 0.2f;    ///< of the skin about joints: share of the thickness there
  int vertices = 6500;      ///< about how many
  float cell = 0.0095f;     ///< of the grid that finds the surface: below the smallest radius
  float coarse_at = 0.07f;  ///< pieces this thick and thicker have the longest edges
  float finest = 0.45f;     ///< the shortest edges, share of the longest
};

/// The body: one closed surface, weights by nearest pieces, joints, all in metres.
Rig rig_of(const CreaturePlan& plan, const std::string& name);

}  // namespace understudy
