// Skeleton extraction with the trained network.
#pragma once

#include <memory>
#include <string>

#include "retarget/nn/part_refiner.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// Loads the extractor. form: "dense" or "paper" (see skeleton_form.hpp); parts, which may be
/// null, refines limbs and head. Throws Error naming the weights file.
std::unique_ptr<SkeletonExtractor> load_network_extractor(const std::string& path, const std::string& form,
                                                          std::unique_ptr<PartRefiner> parts = nullptr);

}  // namespace understudy::nn
