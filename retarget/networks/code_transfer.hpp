// The engine `paper`: a pose's code decoded with a person's (Zheng et al., Sci China Inf Sci 64:210103).
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy::nn {

/// Of the network's form and what it sees; weights of another version are refused.
constexpr int kPoseCodeVersion = 1;
// Sizes, which the paper does not tell: ours.
constexpr int kPoseCodeWidth = 64;      ///< numbers a point in the encoder of poses
constexpr int kPoseCodeBlocks = 4;      ///< of encoder and of decoder
constexpr int kPoseDecoderWidth = 128;  ///< numbers a point of a pose's code, and in the decoder
constexpr int kPersonCodeWidth = 64;    ///< numbers of a person's code
constexpr int kPersonHidden = 128;      ///< of the layers that make it, and scales and shifts of it
constexpr float kCodeVariance = 1e-5f;  ///< added to variances

/// Without LibTorch. The answer is the 15 points; the others ride along. Throws Error naming the file when
/// it is missing, damaged, of another network or of another version.
std::unique_ptr<KeypointTransfer> load_code_transfer(const std::string& path);

}  // namespace understudy::nn
