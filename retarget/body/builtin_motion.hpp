// Motions made by code.
#pragma once

#include <string>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// "walk" or "dance" on the person with these T-pose joints: 5 or 6 s at `fps`, floor at y = 0, starting near
/// the origin and facing +z. Lengths go with the person's legs. Planted feet do not slide: the legs follow by
/// inverse kinematics. Throws Error for another name or a rate outside 5 .. 240.
Motion builtin_motion(const std::string& name, const Joints& rest, float fps = 30);

}  // namespace understudy
