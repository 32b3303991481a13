// How far rotations of tensors are off.
#pragma once

#include <torch/torch.h>

#include "retarget/math/rotation.hpp"

namespace understudy::training {

/// Mean angle in degrees between rotations in their 6D form, [..., 6], not necessarily orthonormal; 0 of none.
inline double mean_angle_deg(const torch::Tensor& rotations, const torch::Tensor& truth) {
  const auto a = rotations.cpu().reshape({-1, 6}).contiguous(), b = truth.cpu().reshape({-1, 6}).contiguous();
  double sum = 0;
  for (int64_t i = 0; i < a.size(0); ++i)
    sum += geodesic_angle(rotation_from_6d(Eigen::Map<const Vec6>(a.data_ptr<float>() + 6 * i)),
                          rotation_from_6d(Eigen::Map<const Vec6>(b.data_ptr<float>() + 6 * i)));
  return sum * 180 / M_PI / static_cast<double>(std::max<int64_t>(1, a.size(0)));
}

}  // namespace understudy::training
