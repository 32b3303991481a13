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

/// The `count` principal shapes of the offsets in these poses (not centred: no weights is no offset); weights
/// of every pose. Up to 120 poses are looked at for the shapes. progress: told 0..1, may throw.
CorrectiveShapes corrective_shapes(const Deformer& deformer, const std::vector<Pose>& poses, int count,
                                   const std::function<void(float)>& progress = {});

}  // namespace understudy
