// Skin weights and pose-corrective offsets by a network, without LibTorch.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// Skin weights and pose-corrective offsets of any target (paper 1, section 3.2); without `offsets` linear
/// blend skinning alone. Its bind() throws Error when a coordinate is not finite or the networks give NaN;
/// deform() before bind() throws. Deforming costs no network: one thread, some milliseconds. Of targets with
/// more than `most_evaluated` vertices one a centimetre is evaluated, more where that is too coarse; the
/// others are interpolated.
std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets,
                                                int most_evaluated = 40000);

/// `count` points distributed over a target's surface, the same set for any order of its points; repeated
/// where there are fewer.
Points spread_points(const Points& points, int count);

}  // namespace understudy::nn
