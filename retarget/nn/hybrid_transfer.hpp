// The engine `hybrid`: the analytic solve of `copy`, corrected by a recurrent network that was trained on the
// extractor's own errors.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// The engine with the weights of a file. Throws Error when the file is missing, damaged or of another
/// version; its push() throws Error when joints are not finite or the network's answer is not.
std::unique_ptr<MotionTransfer> load_hybrid_transfer(const std::string& path);

}  // namespace understudy::nn
