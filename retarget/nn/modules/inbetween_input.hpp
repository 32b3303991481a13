// Windows of motion as tensors.
#pragma once

#include <vector>

#include "retarget/nn/modules/inbetween_net.hpp"

namespace understudy::nn {

/// Of windows with equally many samples.
InbetweenInput input_of(const std::vector<MotionWindow>& windows);

/// Copies poses to a row of rotations [B, T, 22, 3, 3] and root [B, T, 3].
void put_poses(const std::vector<Pose>& poses, int64_t row, torch::Tensor& rotations, torch::Tensor& root);

}  // namespace understudy::nn
