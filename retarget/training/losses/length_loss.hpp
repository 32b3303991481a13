// The loss of bone lengths: joints that are each a little off may leave a thigh too long, and the path with it.
#pragma once

#include <torch/torch.h>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::training {

/// Lengths of the bones from the joints' parents, [..., 21]. joints [..., 22, 3]. Smooth at zero.
inline torch::Tensor bone_lengths(const torch::Tensor& joints) {
  const std::vector<int64_t> parents(kParents.begin() + 1, kParents.end());
  const auto bones = joints.narrow(-2, 1, kJointCount - 1) -
                     joints.index_select(-2, torch::tensor(parents, torch::device(joints.device())));
  return (bones.square().sum(-1) + 1e-6).sqrt();
}

/// Mean difference of bone lengths, in the joints' unit. joints, truth [..., 22, 3].
inline torch::Tensor length_loss(const torch::Tensor& joints, const torch::Tensor& truth) {
  return (bone_lengths(joints) - bone_lengths(truth)).abs().mean();
}

}  // namespace understudy::training
