// Matrices as tensors, and rotations from them.
#pragma once

#include <torch/torch.h>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {

/// A copy, [rows, cols], of a matrix of floats that lies row by row without gaps.
template <class Matrix>
torch::Tensor tensor_of(const Matrix& m) {
  return torch::from_blob(const_cast<float*>(m.data()), {m.rows(), m.cols()}).clone();
}

/// From 22 rotations in any shape that ends with [.., 22, 3, 3], float32 on the CPU.
inline Rotations rotations_of(const torch::Tensor& rotations) {
  const auto flat = rotations.contiguous();
  Rotations made;
  for (int j = 0; j < kJointCount; ++j)
    made[j] = Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(flat.data_ptr<float>() + 9 * j);
  return made;
}

}  // namespace understudy::nn
