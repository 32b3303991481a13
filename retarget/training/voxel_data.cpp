#include "retarget/training/voxel_data.hpp"

#include <algorithm>

#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"

namespace understudy::training {
namespace {

constexpr int kVoxelPoints = 20000;  // on a body's surface (paper 3, B.1)

/// Centres of each frame's cells, as many rows in each, and which of them are there.
void put_centres(const std::vector<VoxelSet>& occupied, int grid, VoxelBatch& batch) {
  size_t most = 0;
  for (const VoxelSet& cells : occupied) most = std::max(most, cells.size());
  const auto F = static_cast<int64_t>(occupied.size());
  batch.cells = torch::zeros({F, static_cast<int64_t>(most), 3});
  batch.counts = torch::zeros({F, static_cast<int64_t>(most)});
  for (int64_t f = 0; f < F; ++f) {
    const VoxelSet& cells = occupied[static_cast<size_t>(f)];
    const auto count = static_cast<int64_t>(cells.size());
    batch.cells[f].narrow(0, 0, count).copy_(nn::tensor_of(VoxelGrid::centres(cells, grid)));
    batch.counts[f].narrow(0, 0, count).fill_(1);
  }
}

}  // namespace

VoxelBatch VoxelData::batch(int windows, int apart, Rng& rng) const {
  VoxelBatch batch;
  const double most = std::min<double>(apart, longest_ * kVoxelRate / (kVoxelWindow - 1));
  for (int w = 0; w < windows; ++w) {
    const RiggedMotion body =
        data_.draw(kVoxelWindow, kVoxelRate / (1 + rng.below(std::max(1, static_cast<int>(most)))), rng);
    const SkinnedPoints drawn = points_on(body.rig, kVoxelPoints, rng);
    std::vector<Points> frames, joints;
    for (const RigPose& pose : body.motion.poses) {
      const BoneMotions bones = bone_motions(body.rig, pose);
      frames.push_back(skinned(drawn.rest, drawn.skin, bones));
      joints.push_back(joint_places(body.rig, bones));
    }
    const VoxelGrid box(frames, grid_);
    for (size_t t = 0; t < frames.size(); ++t) {
      batch.occupied.push_back(box.cells(frames[t]));
      batch.joints.push_back(box.scaled(joints[t]));
    }
  }
  batch.voxels = nn::voxels_of(batch.occupied, grid_).unflatten(0, {windows, kVoxelWindow});
  put_centres(batch.occupied, grid_, batch);
  return batch;
}

}  // namespace understudy::training
