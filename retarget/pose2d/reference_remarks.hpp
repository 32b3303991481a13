// What is odd about the person in a reference picture, for whoever chose it.
#pragma once

#include <string>
#include <vector>

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Whether the trunk points down the picture: a handstand, or a picture on its head. False where neck or
/// mid-hip is missing.
bool is_upside_down(const FlatPose& pose);
/// The picture turned by half about 0, 0.
FlatPose turned_by_half(const FlatPose& pose);

/// Without subject or full stop, as "is seen from behind, ...": seen from behind, sides exchanged, upside
/// down, sitting, on all fours, without legs, of proportions that are hardly a person's. lengths: as
/// believed of whoever stands there. Nothing is refused: lengths are read all the same.
std::vector<std::string> reference_remarks(const FlatPose& standing, const Proportions& lengths);

}  // namespace understudy
