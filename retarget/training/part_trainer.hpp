// Trains the network that sees limbs and head from near.
#pragma once

#include "retarget/networks/networks.hpp"

namespace understudy::training {

/// Trains until the time or the samples (scans) of the options are used up; resumes from `out +
/// ".checkpoint"` when it is there. Writes weights (running average) to `out`, the learning curve to `curve`.
/// 0 when it came to the end, 1 when it was cancelled. Throws Error.
int train_part(const nn::TrainOptions& options);

}  // namespace understudy::training
