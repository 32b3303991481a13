// The filter of 2D points as its gains are fitted; retarget/keypoints/point_filter runs it.
#pragma once

#include <torch/torch.h>

#include <array>

#include "retarget/keypoints/point_gains.hpp"

namespace understudy::nn {

/// What detectors see of B people, in T frames at a fixed rate, P points each.
struct SeenPoints {
  torch::Tensor places;   ///< [B, T, P, 2], pixels; anything where a point is not seen
  torch::Tensor is_seen;  ///< [B, T, P] 1 or 0; 1 in the first frame
  torch::Tensor sigma;    ///< [B, T, P] PointFilter::Noise::sigma of the sighting's confidence, pixels
  torch::Tensor size;     ///< [B, T] PointFilter::Noise::size, pixels
  torch::Tensor dt;       ///< [B] seconds
};

/// PointFilter, by all points at once.
class PointGainsNetImpl : public torch::nn::Module {
 public:
  PointGainsNetImpl();
  /// Places to show [B, T, P, 2]. Points are never given up.
  torch::Tensor forward(const SeenPoints& seen);
  /// As PointGains has them.
  std::array<float, kGainNumbers> numbers() const;
  void set_numbers(const std::array<float, kGainNumbers>& numbers);

 private:
  torch::nn::GRUCell memory;
  torch::nn::Linear out;
};
TORCH_MODULE(PointGainsNet);

}  // namespace understudy::nn
