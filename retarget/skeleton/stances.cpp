#include "retarget/skeleton/stances.hpp"

#include <algorithm>

#include "retarget/base/index.hpp"
#include "retarget/skeleton/foot_contact.hpp"

namespace understudy {

std::vector<Standing> stances(const std::vector<Joints>& joints, float dt, float leg) {
  std::vector<Standing> standing(joints.size(), Standing{});
  const int count = ssize(joints);
  for (int side = 0; side < 2; ++side) {
    float floor = joints[0](LeftFoot + side, 1);
    for (const Joints& frame : joints) floor = std::min(floor, frame(LeftFoot + side, 1));
    for (const bool backwards : {false, true}) {
      ContactSwitch contact({}, leg);
      for (int i = 0; i < count; ++i) {
        const int k = backwards ? count - 1 - i : i;
        if (contact.push(joints[k].row(LeftFoot + side).transpose(), floor, dt) && i > 0)
          standing[k][side] = true;
      }
    }
  }
  return standing;
}

}  // namespace understudy
