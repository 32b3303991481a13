// The loss of a training step, named part by named part, and figures beside it.
#pragma once

#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "retarget/math/rotation.hpp"

namespace understudy::training {

/// A number of the learning curve; its name is its column.
struct Figure {
  std::string name;
  double value = 0;
};
using Figures = std::vector<Figure>;

inline bool all_finite(const Figures& figures) {
  return std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return std::isfinite(f.value); });
}

/// A weighted sum of losses: what is minimised, and the parts as the learning curve shows them, unweighted.
struct LossSum {
  torch::Tensor total;
  Figures parts;

  void add(const char* name, const torch::Tensor& part, double weight = 1) {
    const auto weighted = weight == 1 ? part : weight * part;
    total = total.defined() ? total + weighted : weighted;
    parts.push_back({name, part.item<double>()});
  }
};

/// Means of figures that come in the same order each time.
class RunningMean {
 public:
  void add(const Figures& figures) {
    if (sum_.empty())
      sum_ = figures;
    else
      for (size_t i = 0; i < sum_.size(); ++i) sum_[i].value += figures[i].value;
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  Figures mean() const {
    Figures mean = sum_;
    for (Figure& figure : mean) figure.value /= count_;
    return mean;
  }

 private:
  Figures sum_;
  int count_ = 0;
};

/// Mean angle in degrees between rotations in their 6D form, [..., 6], not necessarily orthonormal;
/// 0 of none.
inline double mean_angle_deg(const torch::Tensor& rotations, const torch::Tensor& truth) {
  const auto a = rotations.cpu().reshape({-1, 6}).contiguous(), b = truth.cpu().reshape({-1, 6}).contiguous();
  double sum = 0;
  for (int64_t i = 0; i < a.size(0); ++i)
    sum += geodesic_angle(rotation_from_6d(Eigen::Map<const Vec6>(a.data_ptr<float>() + 6 * i)),
                          rotation_from_6d(Eigen::Map<const Vec6>(b.data_ptr<float>() + 6 * i)));
  return sum * 180 / M_PI / static_cast<double>(std::max<int64_t>(1, a.size(0)));
}

}  // namespace understudy::training
