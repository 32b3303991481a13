// Patches of the points of a part: small pieces of its surface, far apart.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy::nn {

constexpr int kPartPatches = 32;      ///< patch centres
constexpr int kPartPatchPoints = 16;  ///< nearest points of each centre

constexpr int kPartPatchRows = kPartPatches * (1 + kPartPatchPoints);

/// Of at least kPartPatchPoints points, [N, 3]: the centres, then each one's neighbours less the centre,
/// [kPartPatchRows, 3]. The choice does not depend on the points' order. Centres repeat where points are
/// fewer.
Points cut_part_patches(const Points& points);

}  // namespace understudy::nn
