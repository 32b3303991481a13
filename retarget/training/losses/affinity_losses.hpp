// Which keypoints hang together: free numbers that are learnt beside the keypoints (paper 3, section 4,
// affinity estimation). Keypoints are [W, T, K, 3]: W windows of T frames; their intensities [W, T, K].
#pragma once

#include <torch/torch.h>

namespace understudy::training {

/// Eq. 12: a_ij, the largest over the N matrices, [K, K].
inline torch::Tensor joined_affinity(const torch::Tensor& affinities) {
  return std::get<0>(affinities.max(0));
}

/// Mean over windows, frames and pairs of alpha_k a_kk' cost_kk'; cost [W, T, K, K].
inline torch::Tensor affine_mean(const torch::Tensor& cost, const torch::Tensor& affinity,
                                 const torch::Tensor& intensity) {
  return (intensity.unsqueeze(3) * affinity * cost).mean();
}

/// Squared distances of keypoints, [W, T, K, K].
inline torch::Tensor squared_lengths(const torch::Tensor& places) {
  return (places.unsqueeze(3) - places.unsqueeze(2)).square().sum(4);
}

/// L_traj, eq. 13 and 14: what hangs together goes the same way and speeds up the same way. T >= 3; the
/// intensities are the first frames'.
inline torch::Tensor trajectory_loss(const torch::Tensor& places, const torch::Tensor& affinity,
                                     const torch::Tensor& intensity) {
  const auto alike = [](const torch::Tensor& ways) {  // cosines of [W, T, K, 3] -> [W, T, K, K]
    const auto unit = torch::nn::functional::normalize(
        ways, torch::nn::functional::NormalizeFuncOptions().dim(3).eps(1e-6));
    return torch::matmul(unit, unit.transpose(2, 3));
  };
  const auto T = places.size(1);
  const auto speed = places.narrow(1, 1, T - 1) - places.narrow(1, 0, T - 1);
  const auto more = speed.narrow(1, 1, T - 2) - speed.narrow(1, 0, T - 2);
  const auto cost = 0.5 - 0.25 * (alike(speed.narrow(1, 0, T - 2)) + alike(more));
  return affine_mean(cost, affinity, intensity.narrow(1, 0, T - 2));
}

/// L_local, eq. 15: what hangs together is near.
inline torch::Tensor local_loss(const torch::Tensor& places, const torch::Tensor& affinity,
                                const torch::Tensor& intensity) {
  return affine_mean(squared_lengths(places), affinity, intensity);
}

/// L_time, eq. 16: what hangs together stays as far apart as it is on the whole.
inline torch::Tensor time_loss(const torch::Tensor& places, const torch::Tensor& affinity,
                               const torch::Tensor& intensity) {
  const auto lengths = squared_lengths(places);
  return affine_mean((lengths - lengths.mean(1, true)).abs(), affinity, intensity);
}

/// L_complex, eq. 17: the N matrices [N, K, K] choose different neighbours.
inline torch::Tensor complexity_loss(const torch::Tensor& affinities) {
  auto sum = torch::zeros({}, affinities.options());
  for (int64_t n = 0; n < affinities.size(0); ++n)
    for (int64_t m = 0; m < affinities.size(0); ++m)
      if (n != m) sum = sum + ((affinities[n] * affinities[m]).square().sum() + 1e-12).sqrt();
  return sum;
}

}  // namespace understudy::training
