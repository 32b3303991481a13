// What the network of dynamics minimises (paper 3, eq. 3 and 4), and how well it goes on.
#pragma once

#include "retarget/nn/modules/rotation_vrnn.hpp"
#include "retarget/training/dynamics_data.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

/// Squared angles between rotations [..., J, 3, 3], radians, summed over J and averaged over all else.
torch::Tensor squared_angles(const torch::Tensor& a, const torch::Tensor& b);

/// Rows as the network's form has them: as they are, or with places.
torch::Tensor rows_for(const nn::RotationVrnnImpl& net, const DynamicsBatch& batch,
                       const std::vector<int>& parents);

/// Of sequences that are followed by the posterior: places through forward kinematics and rotations, the
/// root's way, and the divergence of the posterior from the prior.
LossSum dynamics_loss(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents);

/// Joints, in thousandths of the body's size: of frames that the posterior saw, of the tenth one that the
/// prior's means say after ten seen, and of a body that stands still instead; the divergence.
Figures dynamics_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents);

}  // namespace understudy::training
