#include "retarget/math/time_filter.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "retarget/base/error.hpp"

namespace understudy {

float falloff_weight(int frame, int edited, int falloff) {
  const int64_t distance = int64_t{frame} - edited;  // frames come from files: in 64 bits
  const float reach = static_cast<float>(std::max(falloff, 0)) + 1;
  const float x = std::abs(static_cast<float>(distance)) / reach;
  return x >= 1 ? 0.0f : 0.5f + 0.5f * std::cos(kPi * x);
}

std::vector<float> half_gaussian(float strength, float fps) {
  US_CHECK(strength >= 0 && strength <= 1, "smoothing must be in 0..1, not ", strength);
  const float sigma = strength * kSmoothestSeconds * fps;  // frames
  std::vector<float> half;
  if (sigma < 0.05f) return half;
  for (int k = 0; k <= static_cast<int>(std::ceil(3 * sigma)); ++k)
    half.push_back(std::exp(-0.5f * std::pow(static_cast<float>(k) / sigma, 2.0f)));
  return half;
}

std::vector<Mat3> filtered_rotations(const std::vector<Mat3>& in, const std::vector<float>& half) {
  using Quat = Eigen::Quaternionf;
  std::vector<Eigen::Vector4f> q;
  q.reserve(in.size());
  for (const Mat3& R : in) {
    const Eigen::Vector4f now = Quat(R).coeffs();
    const bool far = !q.empty() && q.back().dot(now) < 0;  // q and -q are one rotation: keep to the nearer
    q.push_back(far ? Eigen::Vector4f(-now) : now);
  }
  const std::vector<Eigen::Vector4f> mean = filtered(q, half);
  std::vector<Mat3> out = in;
  for (size_t t = 0; t < q.size(); ++t)
    if (mean[t] != q[t] && mean[t].norm() > 1e-3f)  // opposite rotations have no mean
      out[t] = Quat(mean[t].normalized()).toRotationMatrix();
  return out;
}

}  // namespace understudy
