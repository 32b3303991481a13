// The loss of in-betweening on a batch.
#pragma once

#include "retarget/training/inbetween_data.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

/// Places, turns, speeds and accelerations of the joints in frames that are not known, feet that slide while
/// they truly stand, and what the network tells of standing feet and of its doubt.
LossSum inbetween_loss(const nn::InbetweenOutput& made, const InbetweenBatch& batch);

}  // namespace understudy::training
