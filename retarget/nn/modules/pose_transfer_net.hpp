// A peer to compare with, after the idea of Neural Pose Transfer (Wang et al., CVPR 2020): the points of a
// target are moved into a source's pose, frame by frame, without any skeleton. The target's shape enters by
// spatially adaptive instance normalisation: features are normalised over the points, then scaled and shifted
// as each point's own place on the target says.
#pragma once

#include <torch/torch.h>

namespace understudy::nn {

constexpr int kPoseTransferVersion = 2;
constexpr int64_t kPoseTransferPoints = 1024;  ///< of source and target in training, and of a source scan

/// Normalises over points, then scales and shifts by the target's places and adds what the source's pose
/// says.
class PlaceNormImpl : public torch::nn::Module {
 public:
  PlaceNormImpl(int64_t width, int64_t code);
  /// x [B, N, width], places [B, N, 3], code [B, 1, code] -> [B, N, width]; mean and deviation are those of
  /// the first `counted` points.
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& places, const torch::Tensor& code,
                        int64_t counted);

 private:
  torch::nn::Linear scale{nullptr}, shift{nullptr}, pose{nullptr};
};
TORCH_MODULE(PlaceNorm);

/// Two normalised layers and a way past them.
class PlaceBlockImpl : public torch::nn::Module {
 public:
  PlaceBlockImpl(int64_t from, int64_t to, int64_t code);
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& places, const torch::Tensor& code,
                        int64_t counted);

 private:
  PlaceNorm norm1{nullptr}, norm2{nullptr};
  torch::nn::Linear first{nullptr}, second{nullptr}, past{nullptr};
};
TORCH_MODULE(PlaceBlock);

/// The source is read point by point and pooled, since its points do not correspond to the target's.
class PoseTransferNetImpl : public torch::nn::Module {
 public:
  PoseTransferNetImpl();
  /// source [B, M, 3]: a body in a pose, any points, that faces +z; rest [B, N, 3]: the target in T-pose, of
  /// which the first `counted` points (-1: all) are spread evenly over its surface, as the training's are.
  /// Both around the mean of such points and over their mean distance from it. The target's points in that
  /// pose, [B, N, 3], likewise.
  torch::Tensor forward(const torch::Tensor& source, const torch::Tensor& rest, int64_t counted = -1);

 private:
  torch::nn::Sequential each_point{nullptr}, to_code{nullptr};
  torch::nn::Linear start{nullptr}, finish{nullptr};
  PlaceBlock block1{nullptr}, block2{nullptr}, block3{nullptr};
};
TORCH_MODULE(PoseTransferNet);

}  // namespace understudy::nn
