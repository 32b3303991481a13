#include "retarget/nn/modules/forward_kinematics.hpp"

#include <array>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

torch::Tensor unit(const torch::Tensor& v) {
  return v / v.square().sum(-1, true).add(1e-12).sqrt();
}

}  // namespace

torch::Tensor rotations_from_6d(const torch::Tensor& r6) {
  const auto a1 = r6.slice(-1, 0, 3), a2 = r6.slice(-1, 3, 6);
  const auto b1 = unit(a1);
  const auto b2 = unit(a2 - (b1 * a2).sum(-1, true) * b1);  // a2 minus its b1 part
  const auto b3 = torch::cross(b1, b2, -1);
  return torch::stack({b1, b2, b3}, -1);
}

torch::Tensor rotations_to_6d(const torch::Tensor& rotations) {
  return torch::cat({rotations.select(-1, 0), rotations.select(-1, 1)}, -1);
}

PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local) {
  const int64_t batch = local.size(0);
  std::array<torch::Tensor, kJointCount> joint, global;
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    const auto R = local.select(2, j);  // [B, T, 3, 3]
    if (p < 0) {
      joint[j] = torch::zeros_like(R.select(-1, 0));  // [B, T, 3]
      global[j] = R;
      continue;
    }
    const auto bone = (rest.select(1, j) - rest.select(1, p)).view({batch, 1, 1, 3});
    joint[j] = joint[p] + (global[p] * bone).sum(-1);
    global[j] = torch::matmul(global[p], R);
  }
  return {torch::stack(joint, 2), torch::stack(global, 2)};
}

}  // namespace understudy::nn
