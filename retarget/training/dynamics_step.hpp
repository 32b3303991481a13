// What the network of dynamics minimises (paper 3, eq. 3 and 4), and how well it goes on.
#pragma once

#include "retarget/nn/modules/rotation_vrnn.hpp"
#include "retarget/training/dynamics_data.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

/// Between rotations [..., J, 3, 3]: 2 sqrt(2) sin(angle / 2), summed over J, [...].
torch::Tensor turn_error(const torch::Tensor& a, const torch::Tensor& b);

/// Rows as the network's form has them: as they are, or with places.
torch::Tensor rows_for(const nn::RotationVrnnImpl& net, const DynamicsBatch& batch,
                       const std::vector<int>& parents);

/// Joints on the floor that a way stands on, sizes, [B, T, J, 3]: places about the root [B, T, J, 3] taken to
/// where the root is.
torch::Tensor world_places(const torch::Tensor& way, const torch::Tensor& places);

/// Errors of velocities [..., J, 3] in sizes a second, summed over the joints, [...]; those of joints that
/// stand in truth count more, or feet slide.
torch::Tensor velocity_error(const torch::Tensor& truth, const torch::Tensor& made);

/// Of sequences whose known frames are told: places through forward kinematics and rotations, the root's
/// way, velocities, and the divergence of the posterior from the prior. Where keys are known two sequences of
/// three follow the prior's means, as a network does that fills a gap (after Sohn, Lee, Yan: Learning
/// Structured Output Representation using Deep Conditional Generative Models, NeurIPS 2015, eq. 6); the
/// others follow the posterior.
LossSum dynamics_loss(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents);

/// Joints, in thousandths of the body's size. Of a batch with keys: frames between them, as the network
/// makes them and as the curve through them says. Of one with a beginning: the tenth frame after it that the
/// prior's means say, and of a body that stands still instead.
Figures between_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents);
Figures ahead_figures(nn::RotationVrnn& net, const DynamicsBatch& batch, const std::vector<int>& parents);

}  // namespace understudy::training
