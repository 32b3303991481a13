// The deformation networks as a Deformer: skin weights and pose-corrective offsets of any target (paper 1,
// section 3.2).
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// Reads the weights; without `offsets` it is linear blend skinning alone. Throws Error when the file is
/// missing, damaged or of another version. Its bind() throws Error when a coordinate is not finite or the
/// networks give NaN; deform() before bind() throws. Deforming costs no network: one thread, some
/// milliseconds. Of targets with more than `most_asked` vertices the networks are asked at one a centimetre
/// and where that is too coarse; the others lie between.
std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets,
                                                int most_asked = 40000);

/// `count` points spread over a target's surface, the same set for any order of its points; fewer points are
/// repeated.
Points spread_points(const Points& points, int count);

}  // namespace understudy::nn
