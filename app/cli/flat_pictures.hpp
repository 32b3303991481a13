// Pictures of cases of 2D poses: who performs, who should, and what others make of it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy::app {

/// A moment of a case.
struct FlatMoment {
  std::string name;
  FlatPose source, reference, truth;
  FlatPose one_frame;                                       ///< by limb ratios of one frame each
  std::vector<std::pair<std::string, FlatPose>> engines{};  ///< what each makes of it; at least one
};

/// FOLDER/flat_cases.png: a row each: source, reference, ratios of one frame, those wiped with the first
/// engine, the engines; all but the first two over the truth in grey, boxes' centres aligned. All moments
/// have the same engines. Nothing for no moments.
void write_flat_pictures(const std::string& folder, const std::vector<FlatMoment>& moments);

}  // namespace understudy::app
