// Motions made by code: walk, jog, throw, kick, dance, jumping_jacks.
#pragma once

#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// The names that builtin_motion knows.
const std::vector<std::string>& builtin_motion_names();

/// The motion on the person with these T-pose joints: 3 to 6 s at `fps`, floor at y = 0, starting near the
/// origin and facing +z. Lengths go with the person's legs. Planted feet do not slide: the legs follow by
/// inverse kinematics. Throws Error for an unknown name or a rate outside 5 .. 240.
Motion builtin_motion(const std::string& name, const Joints& rest, float fps = 30);
/// The same on the default built-in person.
Motion builtin_motion(const std::string& name, float fps = 30);

}  // namespace understudy
