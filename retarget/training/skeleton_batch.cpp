#include "retarget/training/skeleton_batch.hpp"

#include <cstring>

#include "retarget/math/rotation.hpp"
#include "retarget/nn/extractor_input.hpp"

namespace understudy::training {
namespace {

constexpr int64_t M = nn::kPatches, J = kJointCount;

// Limbs as (left, right) joints: exchanging them and seeing a smaller error is a swap.
const std::vector<std::vector<std::pair<int, int>>> kLimbs = {
    {{LeftShoulder, RightShoulder}, {LeftElbow, RightElbow}, {LeftWrist, RightWrist}},
    {{LeftHip, RightHip}, {LeftKnee, RightKnee}, {LeftAnkle, RightAnkle}, {LeftFoot, RightFoot}}};

double swaps(const Joints& found, const Joints& truth) {
  int count = 0;
  for (const auto& limb : kLimbs) {
    float straight = 0, crossed = 0;
    for (const auto& [l, r] : limb) {
      straight += (found.row(l) - truth.row(l)).norm() + (found.row(r) - truth.row(r)).norm();
      crossed += (found.row(r) - truth.row(l)).norm() + (found.row(l) - truth.row(r)).norm();
    }
    count += crossed < straight;
  }
  return count / static_cast<double>(kLimbs.size());
}

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
    const nn::ScanPatches& patches = all[static_cast<size_t>(b)];
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

std::vector<Joints> world_joints(const nn::ExtractorOutput& out, const SkeletonBatch& batch) {
  const auto world =
      (out.joints.detach() * batch.scale.view({-1, 1, 1}) + batch.centre.unsqueeze(1)).cpu().contiguous();
  std::vector<Joints> joints;
  for (int64_t b = 0; b < world.size(0); ++b)
    joints.emplace_back(Eigen::Map<const Joints>(world[b].data_ptr<float>()));
  return joints;
}

SkeletonScore score(const nn::ExtractorOutput& out, const SkeletonBatch& batch) {
  const auto joints = out.joints.cpu().contiguous(), truth = batch.truth.joints.cpu().contiguous();
  const bool turns = out.rotations.defined();
  const auto rotations = (turns ? out.rotations : batch.truth.rotations).cpu().contiguous(),
             true_rotations = batch.truth.rotations.cpu().contiguous();
  const auto scale = batch.scale.cpu();
  const int64_t B = joints.size(0);
  SkeletonScore s;
  for (int64_t b = 0; b < B; ++b) {
    const Joints p = Eigen::Map<const Joints>(joints[b].data_ptr<float>());
    const Joints q = Eigen::Map<const Joints>(truth[b].data_ptr<float>());
    s.joint_mm += 1000.0 * scale.data_ptr<float>()[b] * (p - q).rowwise().norm().mean() / B;
    s.swap_rate += swaps(p, q) / B;
    for (int64_t j = 0; j < J; ++j) {
      const Mat3 P = rotation_from_6d(Eigen::Map<const Vec6>(rotations[b][j].data_ptr<float>()));
      const Mat3 Q = rotation_from_6d(Eigen::Map<const Vec6>(true_rotations[b][j].data_ptr<float>()));
      s.rotation_deg += geodesic_angle(P, Q) * 180.0 / kPi / static_cast<double>(B * J);
    }
  }
  return s;
}

}  // namespace understudy::training
