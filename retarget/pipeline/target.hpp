// A target prepared for the pipeline: its T-pose and the joints found in it.
#pragma once

#include <string>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

struct Target {
  Mesh mesh;                          ///< T-pose, facing +z
  Joints joints = Joints::Zero();     ///< T-pose joints
  std::vector<std::string> warnings;  ///< where it does not look like a person in T-pose
};

/// Finds the T-pose joints of a target: the mean over random samples, small turns and mirror images; made
/// symmetric when the target is. Never refuses: what does not look like a person in T-pose is listed in
/// `warnings`. Throws Error when the mesh has fewer than 32 finite points.
Target prepare_target(const Mesh& mesh, SkeletonExtractor& extractor);
/// A target whose T-pose joints are known.
Target prepare_target(const Mesh& mesh, const Joints& joints);

}  // namespace understudy
