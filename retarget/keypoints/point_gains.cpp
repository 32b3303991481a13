#include "retarget/keypoints/point_gains.hpp"

namespace understudy {
namespace {

constexpr std::array<float, kGainNumbers> kFittedGains = {
#include "retarget/keypoints/point_gains.inc"
};

}  // namespace

PointGains::PointGains(const std::array<float, kGainNumbers>& numbers) {
  const float* next = numbers.data();
  const auto take = [&next](auto& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row)
      for (Eigen::Index column = 0; column < matrix.cols(); ++column) matrix(row, column) = *next++;
  };
  take(from_features_), take(from_memory_), take(features_bias_), take(memory_bias_);
  take(out_), take(out_bias_);
}

const PointGains& PointGains::fitted() {
  static const PointGains gains(kFittedGains);
  return gains;
}

const std::array<float, kGainNumbers>& PointGains::fitted_numbers() {
  return kFittedGains;
}

Eigen::Vector4f PointGains::gains(const GainFeatures& features, GainMemory& memory) const {
  constexpr int H = kGainHidden;
  const auto logistic = [](const auto& x) { return (1 + (-x).exp()).inverse(); };
  const Gates in = from_features_ * features + features_bias_, kept = from_memory_ * memory + memory_bias_;
  const Eigen::Array<float, 2 * H, 1> gates = logistic((in + kept).head<2 * H>().array());
  const Eigen::Array<float, H, 1> made =
      (in.tail<H>().array() + gates.head<H>() * kept.tail<H>().array()).tanh();
  memory = (made + gates.tail<H>() * (memory.array() - made)).matrix();
  return logistic((out_ * memory + out_bias_).array());
}

}  // namespace understudy
