// The extractor `dense`, without LibTorch.
#pragma once

#include <memory>
#include <string>

#include "retarget/networks/part_refiner.hpp"

namespace understudy::nn {

/// parts, which may be null, refines limbs and head. Throws Error when the file is missing, damaged, of
/// another network or of another version.
std::unique_ptr<SkeletonExtractor> load_dense_extractor(const std::string& path,
                                                        std::unique_ptr<PartRefiner> parts = nullptr);

}  // namespace understudy::nn
