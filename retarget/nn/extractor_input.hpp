// Scans and the joints of the frames before them, as tensors.
#pragma once

#include <vector>

#include "retarget/networks/scan_patches.hpp"
#include "retarget/nn/modules/skeleton_extractor.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// A batch of B scans, on the CPU. `recent`: the extracted joints of the frames before each scan; empty for
/// scans of no stream.
ExtractorInput extractor_input(const std::vector<ScanPatches>& patches,
                               const std::vector<RecentJoints>& recent = {});

}  // namespace understudy::nn
