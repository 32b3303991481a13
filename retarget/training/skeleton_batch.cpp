#include "retarget/training/skeleton_batch.hpp"

#include <cstring>

#include "retarget/math/rotation.hpp"
#include "retarget/nn/extractor_input.hpp"
#include "retarget/training/losses/length_loss.hpp"
#include "retarget/training/losses/skeleton_losses.hpp"

namespace understudy::training {
namespace {

constexpr int64_t M = nn::kPatches, J = kJointCount;

}  // namespace

SkeletonBatch make_batch(const std::vector<MadeScan>& scans, const std::vector<RecentJoints>& recent) {
  const auto B = static_cast<int64_t>(scans.size());
  std::vector<nn::ScanPatches> all;
  for (const MadeScan& scan : scans) all.push_back(nn::cut_patches(scan.points));
  SkeletonBatch batch;
  batch.input = nn::extractor_input(all, recent);
  batch.scale = torch::empty({B});
  batch.centre = torch::empty({B, 3});
  batch.truth.joints = torch::empty({B, J, 3});
  batch.truth.rotations = torch::empty({B, J, 6});
  batch.truth.parts = torch::empty({B, M}, torch::kInt64);
  for (int64_t b = 0; b < B; ++b) {
    const MadeScan& scan = scans[b];
    const nn::ScanPatches& patches = all[b];
    batch.scale.data_ptr<float>()[b] = patches.scale;
    std::memcpy(batch.centre[b].data_ptr<float>(), patches.centre.data(), sizeof(float) * 3);
    const Joints joints = (scan.truth.joints.rowwise() - patches.centre.transpose()) / patches.scale;
    std::memcpy(batch.truth.joints[b].data_ptr<float>(), joints.data(), sizeof(float) * joints.size());
    for (int64_t j = 0; j < J; ++j) {
      const Vec6 r = rotation_to_6d(scan.truth.global[j]);
      std::memcpy(batch.truth.rotations[b][j].data_ptr<float>(), r.data(), sizeof(float) * 6);
    }
    for (int64_t m = 0; m < M; ++m)
      batch.truth.parts.data_ptr<int64_t>()[b * M + m] = scan.parts[patches.centre_index[m]];
  }
  return batch;
}

SkeletonBatch to_device(const SkeletonBatch& batch, const torch::Device& device) {
  const nn::ExtractorInput& in = batch.input;
  const auto moved = [&](const torch::Tensor& x) { return x.defined() ? x.to(device) : x; };
  return {{in.points.to(device), in.centres.to(device), in.offsets.to(device), moved(in.recent),
           moved(in.recent_known)},
          batch.scale.to(device),
          batch.centre.to(device),
          {batch.truth.joints.to(device), batch.truth.rotations.to(device), batch.truth.parts.to(device)}};
}

LossSum skeleton_loss(const nn::ExtractorOutput& out, const SkeletonBatch& batch) {
  const SkeletonTruth& truth = batch.truth;
  LossSum loss;
  if (!out.votes.defined()) {
    loss.add("joint_loss", (out.joints - truth.joints).square().mean());
    return loss;
  }
  const auto error = (out.joints - truth.joints).square().sum(-1).sqrt();  // [B, 22]
  loss.add("joint_loss", mean_distance(out.joints, truth.joints) + mean_distance(out.voted, truth.joints));
  loss.add("vote_loss", vote_loss(out.votes, batch.input.centres, truth.joints, /*reach=*/0.8));
  loss.add("part_loss", torch::nn::functional::cross_entropy(out.parts.flatten(0, 1), truth.parts.flatten()),
           0.05);
  loss.add("rotation_loss", (out.rotations - truth.rotations).abs().mean(), 0.3);
  loss.add("length_loss", length_loss(out.joints, truth.joints), 0.3);
  loss.add("spread_loss", spread_loss(error, out.log_spread), 0.01);
  return loss;
}

std::vector<Joints> world_joints(const nn::ExtractorOutput& out, const SkeletonBatch& batch) {
  const auto world =
      (out.joints.detach() * batch.scale.view({-1, 1, 1}) + batch.centre.unsqueeze(1)).cpu().contiguous();
  std::vector<Joints> joints;
  for (int64_t b = 0; b < world.size(0); ++b)
    joints.emplace_back(Eigen::Map<const Joints>(world[b].data_ptr<float>()));
  return joints;
}

}  // namespace understudy::training
