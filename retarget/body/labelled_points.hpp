// Points on a person with the part of the body that each is on.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

constexpr int kNoBody = kJointCount;  ///< part of what is not the person: floor, outliers, held things

struct LabelledPoints {
  Points points;           ///< [N, 3], metres
  std::vector<int> parts;  ///< [N] joint that the point follows most, or kNoBody
};

/// Keeps the rows named, in that order; a row may be named twice.
void keep_rows(LabelledPoints& cloud, const std::vector<int>& kept);

/// Each point's part: the joint at the upper end of the nearest bone; beyond a limb's last joint that one.
std::vector<int> nearest_parts(const Points& points, const Joints& joints);

}  // namespace understudy
