// Pose-corrective offsets of a motion as a few shapes with weights over time.
#pragma once

#include <functional>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

struct CorrectiveShapes {
  std::vector<Points> shapes;               ///< [V, 3] each, metres, T-pose axes, small offsets cut to zero
  std::vector<std::vector<float>> weights;  ///< [poses][shapes]
};

/// `count` shapes for the offsets in these poses: the first is there in all of them with weight 1, the others
/// are the principal ways in which the poses differ, with weights in 0..1. No weights is no offset. Up to 120
/// poses are looked at for the shapes. progress: told 0..1, may throw.
CorrectiveShapes corrective_shapes(const Deformer& deformer, const std::vector<Pose>& poses, int count,
                                   const std::function<void(float)>& progress = {});

}  // namespace understudy
