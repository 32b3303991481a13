// Joints and rotations as tensors, and back.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {

/// [22, 3]
torch::Tensor to_tensor(const Joints& joints);
/// [22, 3, 3]
torch::Tensor to_tensor(const Rotations& rotations);
/// From [22, 3], float32 on the CPU.
Joints to_joints(const torch::Tensor& joints);
/// From [22, 3, 3], float32 on the CPU.
Rotations to_rotations(const torch::Tensor& rotations);

}  // namespace understudy::nn
