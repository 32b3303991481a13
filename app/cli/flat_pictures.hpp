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
  FlatPose one_frame, ours;  ///< by limb ratios of one frame each; by the engine
  std::string engine;        ///< its name
};

/// FOLDER/flat_cases.png: a row each: source, reference, ratios of one frame, both wiped, the engine; the last three
/// over the truth in grey, boxes' centres aligned. Nothing for no moments.
void write_flat_pictures(const std::string& folder, const std::vector<FlatMoment>& moments);

}  // namespace understudy::app
