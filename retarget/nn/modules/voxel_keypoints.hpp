// Paper 3's own detector of keypoints (Neural Marionette, section 4 and supplement A.1): a sequence of grids
// of voxels in, the trajectories of K keypoints out, and the grids again from these. Learnt without labels.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::nn {

/// Version of the network's form.
constexpr int kVoxelKeypointsVersion = 2;
/// N of the paper: how many others a keypoint may be tied to.
constexpr int64_t kAffinityMatrices = 2;

struct VoxelKeypointsForm {
  int64_t keypoints = 24;  ///< K
  int64_t grid = 32;       ///< cells along an edge, a multiple of 32; the paper's is 64
  int64_t width = 32;      ///< C, channels of the features, a multiple of 16; the paper's is 128
  double sigma = 1.5;      ///< of the Gaussians about keypoints, sixteenths of the edge (the paper's cells)
};

/// Everything in the box of the sequence, [-1, 1]^3, axes x, y, z; grids [.., z, y, x].
struct VoxelKeypoints {
  torch::Tensor places;     ///< mu, [F, K, 3]
  torch::Tensor intensity;  ///< alpha, [F, K], the largest of each frame is 1
  torch::Tensor heatmaps;   ///< m, [F, K, G/4, G/4, G/4]
  torch::Tensor features;   ///< c, [F, C, G/4, G/4, G/4]
};

/// Two convolutions beside the way straight on.
class VoxelResidualImpl : public torch::nn::Module {
 public:
  VoxelResidualImpl(int64_t from, int64_t to);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::nn::Conv3d first{nullptr}, second{nullptr}, straight{nullptr};
  torch::nn::GroupNorm first_norm{nullptr}, second_norm{nullptr};
};
TORCH_MODULE(VoxelResidual);

/// What is about each cell at `channels.size() - 1` coarser scales, channels.front() in and out.
class VoxelHourglassImpl : public torch::nn::Module {
 public:
  explicit VoxelHourglassImpl(const std::vector<int64_t>& channels);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  std::vector<torch::nn::Conv3d> narrow, wide;
  std::vector<torch::nn::GroupNorm> norms;
  std::vector<VoxelResidual> beside, within;
};
TORCH_MODULE(VoxelHourglass);

/// f_feat: voxels and the coordinates of their cells -> features at a quarter of the resolution.
class VoxelFeaturesImpl : public torch::nn::Module {
 public:
  VoxelFeaturesImpl(int64_t grid, int64_t width);
  /// [F, 1, G, G, G] -> [F, width, G/4, G/4, G/4]
  torch::Tensor forward(const torch::Tensor& voxels);

 private:
  torch::Tensor cells;  // [1, 3, G, G, G]
  torch::nn::Conv3d see{nullptr}, see_where{nullptr}, halve{nullptr}, halve_again{nullptr};
  torch::nn::GroupNorm see_norm{nullptr}, halve_norm{nullptr}, halve_again_norm{nullptr};
  VoxelResidual wider{nullptr}, last{nullptr};
  VoxelHourglass hourglass{nullptr};
};
TORCH_MODULE(VoxelFeatures);

/// f_dec, eq. 7: Gaussians of this frame and of the first, features of the first and coordinates -> what is
/// different from the first frame.
class VoxelDecoderImpl : public torch::nn::Module {
 public:
  explicit VoxelDecoderImpl(const VoxelKeypointsForm& form);
  /// now, first [F, K, g, g, g], features [F, C, g, g, g], voxels of the first frame [F, 1, G, G, G] ->
  /// logits of occupancy [F, 1, G, G, G]
  torch::Tensor forward(const torch::Tensor& now, const torch::Tensor& first, const torch::Tensor& features,
                        const torch::Tensor& voxels);

 private:
  torch::Tensor cells;  // [1, 3, g, g, g]
  torch::nn::Conv3d join{nullptr}, half{nullptr}, half_again{nullptr}, full{nullptr}, full_again{nullptr},
      out{nullptr};
  torch::nn::GroupNorm join_norm{nullptr}, half_norm{nullptr}, half_again_norm{nullptr}, full_norm{nullptr},
      full_again_norm{nullptr};
};
TORCH_MODULE(VoxelDecoder);

/// The paper's form in all its parts, of any size, but that sizes which it gives for 64 cells and 128
/// channels scale with those. What is trained here is small: an ablation, not what the paper measures.
class VoxelKeypointsNetImpl : public torch::nn::Module {
 public:
  explicit VoxelKeypointsNetImpl(const VoxelKeypointsForm& form);
  const VoxelKeypointsForm& form() const { return form_; }

  /// What a whole sequence tells each of its frames (eq. 6): K maps of the mean over time. voxels
  /// [W, T, 1, G, G, G] -> [W, K, g, g, g].
  torch::Tensor maps_over_time(const torch::Tensor& voxels);
  /// Of single frames [F, 1, G, G, G], each with the maps over time of its sequence [F, K, g, g, g] (eq. 5
  /// and 6).
  VoxelKeypoints of_frames(const torch::Tensor& voxels, const torch::Tensor& over_time);
  /// Of W windows of T frames, [W, T, 1, G, G, G]; F = W T.
  VoxelKeypoints forward(const torch::Tensor& voxels);
  /// The grids from what forward() said of them: logits of occupancy [W T, 1, G, G, G].
  torch::Tensor decoded(const VoxelKeypoints& keypoints, const torch::Tensor& voxels);
  /// A_n of eq. 12, [N, K, K]: free numbers, a softmax each row, nothing on the diagonal.
  torch::Tensor affinities() const;

 private:
  torch::Tensor gaussians(const VoxelKeypoints& keypoints) const;

  VoxelKeypointsForm form_;
  VoxelFeatures features{nullptr}, features_over_time{nullptr};
  torch::nn::Conv3d maps{nullptr}, maps_of_time{nullptr}, mix{nullptr};  // f_heat
  VoxelDecoder decoder{nullptr};
  torch::Tensor free_affinity, line;  // [N, K, K - 1]; centres along an edge of the heatmaps, [g]
};
TORCH_MODULE(VoxelKeypointsNet);

/// Grids [T, 1, G, G, G] of ones where points are: frames in one box, cells as VoxelGrid numbers them.
torch::Tensor voxels_of(const std::vector<std::vector<int>>& cells, int64_t grid);

}  // namespace understudy::nn
