// Forward kinematics as a differentiable layer, and rotations of tensors from 6D forms and quaternions.
#pragma once

#include <torch/torch.h>

#include <vector>

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
  torch::Tensor joints;  ///< [B, T, J, 3] metres, the root at the origin
  torch::Tensor global;  ///< [B, T, J, 3, 3] rotation of each joint's frame
};

/// Joints of bodies with rest joints `rest` [B, J, 3] under local rotations [B, T, J, 3, 3] (paper 3, eq. 2);
/// parents: -1 of the root, which comes first, as every parent before its children. Differentiable in both.
PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local,
                               const std::vector<int>& parents);
/// The same of people's 22 joints.
PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local);

}  // namespace understudy::nn
