#include "retarget/nn/modules/forward_kinematics.hpp"

#include "retarget/base/index.hpp"
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

torch::Tensor rotations_from_quaternions(const torch::Tensor& quaternions) {
  const auto q = unit(quaternions);
  const auto w = q.select(-1, 0), x = q.select(-1, 1), y = q.select(-1, 2), z = q.select(-1, 3);
  const auto row = [](const torch::Tensor& a, const torch::Tensor& b, const torch::Tensor& c) {
    return torch::stack({a, b, c}, -1);
  };
  return torch::stack({row(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                       row(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                       row(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))},
                      -2);
}

PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local) {
  return forward_kinematics(rest, local, {kParents.begin(), kParents.end()});
}

PosedBodies forward_kinematics(const torch::Tensor& rest, const torch::Tensor& local,
                               const std::vector<int>& parents) {
  const int64_t batch = local.size(0);
  std::vector<torch::Tensor> joint(parents.size()), global(parents.size());
  for (int j = 0; j < ssize(parents); ++j) {
    const int p = parents[j];
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
