#include "retarget/nn/modules/affinity.hpp"

namespace understudy::nn {

torch::Tensor affinities_of(const torch::Tensor& free) {
  const int64_t N = free.size(0), K = free.size(1);
  const auto rows = free.softmax(2);  // [N, K, K - 1]
  // Row i of K - 1 numbers leaves out column i: with a zero before every K of them they fall into place.
  const auto padded = torch::constant_pad_nd(rows.reshape({N, K - 1, K}), {1, 0});  // [N, K - 1, K + 1]
  return torch::constant_pad_nd(padded.flatten(1), {0, 1}).view({N, K, K});
}

std::vector<RowMatrix> matrices_of(const torch::Tensor& affinities) {
  const auto flat = affinities.detach().cpu().contiguous();
  const auto K = static_cast<Eigen::Index>(flat.size(1));
  std::vector<RowMatrix> matrices;
  for (int64_t n = 0; n < flat.size(0); ++n)
    matrices.push_back(Eigen::Map<const RowMatrix>(flat.data_ptr<float>() + n * K * K, K, K));
  return matrices;
}

}  // namespace understudy::nn
