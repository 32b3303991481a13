// Skeleton extraction with the trained network, for users without LibTorch.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// Loads the extractor. form: "dense", "paper" or "pointnet" (see skeleton_form.hpp). Throws Error naming the
/// weights file.
std::unique_ptr<SkeletonExtractor> load_network_extractor(const std::string& path, const std::string& form);

}  // namespace understudy::nn
