// What the network that reads lengths off 2D poses minimises, and what it says of poses.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/nn/modules/proportion_net.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/proportion_data.hpp"

namespace understudy::training {

/// The negative logarithm of the lengths' likelihood, each logarithm normal by itself; beside it how far the
/// logarithms are off on average.
LossSum proportion_loss(nn::ProportionNet& net, const ProportionBatch& batch, const torch::Device& device);

/// As NetworkLengthReader reads them, each pose and its mirror image, all at once.
std::vector<PoseLengths> read_lengths(nn::ProportionNet& net, const std::vector<FlatPose>& poses);

}  // namespace understudy::training
