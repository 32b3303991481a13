// What paper 3's own network learns from: windows of voxel grids of one body that moves.
#pragma once

#include <torch/torch.h>

#include "retarget/metrics/voxel_metrics.hpp"
#include "retarget/training/kind_data.hpp"

namespace understudy::training {

constexpr int kVoxelWindow = 10;  ///< T, frames of a window (paper 3, table 3)
/// Frames a second at most: every second of AIST++'s 60 (table 4); the paper's data of other kinds, which are
/// sampled at rate 1, have about as many.
constexpr double kVoxelRate = 30;

/// W windows of T frames; the box is one a window.
struct VoxelBatch {
  torch::Tensor voxels;            ///< [W, T, 1, G, G, G] 0 or 1
  torch::Tensor cells;             ///< [W T, P, 3] centres of those that are occupied, in [-1, 1]^3
  torch::Tensor counts;            ///< [W T, P] 0 or 1: which of the rows are there
  std::vector<Points> joints;      ///< [W T] of [J, 3] true ones, in the box: for figures alone
  std::vector<VoxelSet> occupied;  ///< [W T]
};

class VoxelData {
 public:
  VoxelData(const std::string& kind, const std::string& folder, Split split, int grid)
      : data_(kind, folder, split), grid_(grid), longest_(data_.longest()) {}
  /// apart: the most frames, of kVoxelRate a second, from one of a window to the next; fewer where no clip is
  /// as long. What finds keypoints sees seconds at once: in a third of one little tells them apart.
  VoxelBatch batch(int windows, int apart, Rng& rng) const;

 private:
  KindData data_;
  int grid_;
  double longest_;  // seconds
};

}  // namespace understudy::training
