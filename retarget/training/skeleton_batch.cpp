#include "retarget/training/skeleton_batch.hpp"

#include <algorithm>

#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/training/losses/skeleton_losses.hpp"

namespace understudy::training {

float joint_weight(float away) {
  return std::clamp(1.4f - 2 * away, 0.2f, 1.0f);
}

SkeletonBatch make_batch(const std::vector<MadeScan>& scans, const std::vector<RecentJoints>& recent) {
  std::vector<nn::ScanPatches> all;
  std::vector<float> scales;
  std::vector<torch::Tensor> centres, joints, rotations, parts, seen, weights;
  for (const MadeScan& scan : scans) {
    const nn::ScanPatches& patches = all.emplace_back(nn::cut_patches(scan.points));
    scales.push_back(patches.scale);
    centres.push_back(nn::tensor_of(patches.centre).flatten());
    joints.push_back(
        nn::tensor_of(Joints((scan.truth.joints.rowwise() - patches.centre.transpose()) / patches.scale)));
    Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor> r6;
    for (int j = 0; j < kJointCount; ++j) r6.row(j) = rotation_to_6d(scan.truth.global[j]).transpose();
    rotations.push_back(nn::tensor_of(r6));
    std::vector<int64_t> own;
    for (const int centre : patches.centre_index) own.push_back(scan.parts[centre]);
    parts.push_back(torch::tensor(own));
    seen.push_back(nn::tensor_of(scan.sight.seen).flatten());
    weights.push_back(nn::tensor_of(PerJoint(scan.sight.away.unaryExpr(&joint_weight))).flatten());
  }
  return {nn::extractor_input(all, recent),
          torch::tensor(scales),
          torch::stack(centres),
          {torch::stack(joints), torch::stack(rotations), torch::stack(parts), torch::stack(seen),
           torch::stack(weights)}};
}

SkeletonBatch to_device(const SkeletonBatch& batch, const torch::Device& device) {
  const nn::ExtractorInput& in = batch.input;
  const auto moved = [&](const torch::Tensor& x) { return x.defined() ? x.to(device) : x; };
  return {{in.points.to(device), in.centres.to(device), in.offsets.to(device), moved(in.recent),
           moved(in.recent_known)},
          batch.scale.to(device),
          batch.centre.to(device),
          {batch.truth.joints.to(device), batch.truth.rotations.to(device), batch.truth.parts.to(device),
           batch.truth.seen.to(device), batch.truth.weights.to(device)}};
}

LossSum skeleton_loss(const nn::ExtractorOutput& out, const SkeletonBatch& batch) {
  const SkeletonTruth& truth = batch.truth;
  LossSum loss;
  if (!out.votes.defined()) {
    loss.add("joint_loss", square_loss(out.joints, truth.joints));
    return loss;
  }
  const auto error = (out.joints - truth.joints).square().sum(-1).sqrt();  // [B, 22]
  const torch::Tensor& weights = truth.weights;
  loss.add("joint_loss", mean_distance(out.joints, truth.joints, weights) +
                             mean_distance(out.voted, truth.joints, weights));
  loss.add("vote_loss", vote_loss(out.votes, batch.input.centres, truth.joints, /*reach=*/0.8));
  loss.add("part_loss", label_loss(out.parts, truth.parts), 0.05);
  loss.add("rotation_loss", columns_loss(out.rotations, truth.rotations, weights), 0.3);
  loss.add("length_loss", length_loss(out.joints, truth.joints, weights), 0.3);
  loss.add("spread_loss", spread_loss(error, out.log_spread), 0.01);
  loss.add("visibility_loss", visibility_loss(out.visibility, truth.seen), 0.03);
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
