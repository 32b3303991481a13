// Motion files made by the tests.
#pragma once

#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {

struct MadeBvh {
  Naming naming = Naming::Cmu;
  float unit = 1;                 ///< of the file in metres
  bool z_up = false;              ///< offsets and motion
  bool only_motion_z_up = false;  ///< the offsets stay y up
  std::string order = "ZXY";      ///< of the turns
  double fps = 120;
};

/// A person whose T-pose joints are `rest` in these poses, with end sites.
std::string made_bvh(const MadeBvh& options, const Joints& rest, const std::vector<Pose>& poses);

}  // namespace understudy::tests
