// Bodies of a kind that move, as the network of their dynamics (paper 3) sees them.
#pragma once

#include <torch/torch.h>

#include <string>
#include <vector>

#include "retarget/training/kind_data.hpp"

namespace understudy::training {

struct DynamicsBatch {
  torch::Tensor rows;  ///< [B, T, 4 + 6 J], see nn::RotationVrnn; the first frame does not know its speeds: 0
  torch::Tensor dt;    ///< [B, T] seconds since the frame before
  torch::Tensor rest;  ///< [B, J, 3] joints at rest about the root, sizes
};

class DynamicsData {
 public:
  /// Throws Error as KindData does.
  DynamicsData(const std::string& kind, const std::string& folder, Split split);
  DynamicsBatch batch(int count, int frames, Rng& rng) const;
  const std::vector<int>& parents() const { return parents_; }
  /// See bones_of().
  const std::string& bones() const { return bones_; }

 private:
  KindData kinds_;
  std::vector<int> parents_;
  std::string bones_;
};

}  // namespace understudy::training
