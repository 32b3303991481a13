// Forward kinematics as a differentiable layer, and rotations of tensors from 6D forms and quaternions.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

/// Rotation matrices from their 6D form by Gram-Schmidt (Zhou et al., CVPR 2019, eq. 15). [..., 6] -> [...,
/// 3, 3].
torch::Tensor rotations_from_6d(const torch::Tensor& r6);
/// The first two columns, one after the other. [..., 3, 3] -> [..., 6].
torch::Tensor rotations_to_6d(const torch::Tensor& rotations);
/// Rotation matrices from quaternions w, x, y, z of any length but zero. [..., 4] -> [..., 3, 3].
torch::Tensor rotations_from_quaternions(const torch::Tensor& quaternions);

/// Bodies in poses.
struct PosedBodies {
  torch::Tensor joints;  ///< [B, T, 22, 3] metres, the pelvis at the origin
  torch::Tensor global;  ///< [B, T, 22, 3, 3] rotation of each joint's frame
};

/// Joints of bodies with T-pose joints `rest` [B, 22, 3] under local rotations [B, T, 22, 3, 3].
/// Differentiable in both.
PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local);

}  // namespace understudy::nn
