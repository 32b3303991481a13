// Scans and what was seen before them as tensors.
#pragma once

#include <vector>

#include "retarget/networks/scan_patches.hpp"
#include "retarget/nn/modules/skeleton_extractor.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// B scans beside each other, on the CPU. `recent` is what was seen in the frames before each of them, or
/// empty: scans of no stream.
ExtractorInput extractor_input(const std::vector<ScanPatches>& patches,
                               const std::vector<RecentJoints>& recent = {});

}  // namespace understudy::nn
