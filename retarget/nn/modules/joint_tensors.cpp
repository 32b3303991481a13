#include "retarget/nn/modules/joint_tensors.hpp"

namespace understudy::nn {

using RowMajor3 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

torch::Tensor to_tensor(const Joints& joints) {
  return torch::from_blob(const_cast<float*>(joints.data()), {kJointCount, 3}, torch::kFloat32).clone();
}

torch::Tensor to_tensor(const Rotations& rotations) {
  auto tensor = torch::empty({kJointCount, 3, 3});
  for (int j = 0; j < kJointCount; ++j)
    Eigen::Map<RowMajor3>(tensor.data_ptr<float>() + 9 * j) = rotations[j];
  return tensor;
}

Joints to_joints(const torch::Tensor& joints) {
  const auto flat = joints.contiguous();
  return Eigen::Map<const Joints>(flat.data_ptr<float>());
}

Rotations to_rotations(const torch::Tensor& rotations) {
  const auto flat = rotations.contiguous();
  Rotations made;
  for (int j = 0; j < kJointCount; ++j) made[j] = Eigen::Map<const RowMajor3>(flat.data_ptr<float>() + 9 * j);
  return made;
}

}  // namespace understudy::nn
