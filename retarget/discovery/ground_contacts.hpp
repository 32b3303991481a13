// What of a body stands on the ground while it moves, and how another body's bones stand there, too.
#pragma once

#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

/// Which bones touch the lowest ground and stay there.
struct GroundContacts {
  float ground = 0;                        ///< y, metres
  std::vector<std::vector<char>> touches;  ///< [T][J]
};
/// The lowest point of a bone touches when it is within 2 % of the body's size of the ground and hardly
/// moves. The rig has a surface.
GroundContacts ground_contacts(const RiggedMotion& body);

/// Poses a performance so that bones which touch stay on the ground: the path first, then the last two bones
/// of each. touches: [T][J of the performance].
void stand_on(float ground, const std::vector<std::vector<char>>& touches, RiggedMotion& performance);
/// The same where the path is right as it is: only the last two bones.
void bend_onto(float ground, const std::vector<std::vector<char>>& touches, RiggedMotion& performance);

}  // namespace understudy
