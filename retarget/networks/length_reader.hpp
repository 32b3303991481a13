// Lengths of a person's bones by a small network that sees one 2D pose.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy::nn {

/// Of the network's form and what it sees; weights of another version are refused.
constexpr int kProportionVersion = 1;
constexpr int kProportionWidth = 448;
/// What the network's logarithms of deviations are kept between.
constexpr float kLeastLogDoubt = -5, kMostLogDoubt = 1;

/// Without LibTorch. It reads each pose and its mirror image. Throws Error naming the file when it is
/// missing, damaged, of another network or of another version.
std::unique_ptr<LengthReader> load_network_length_reader(const std::string& path);

}  // namespace understudy::nn
