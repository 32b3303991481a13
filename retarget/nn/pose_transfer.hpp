// Pose transfer without a skeleton, a peer to compare with (nn/modules/pose_transfer_net.hpp).
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/surface_transfer.hpp"

namespace understudy::nn {

/// Throws Error when the file is missing, damaged or of another version.
std::unique_ptr<SurfaceTransfer> load_pose_transfer(const std::string& path);

}  // namespace understudy::nn
