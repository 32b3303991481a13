// How much keypoints hang together, as free numbers that are learnt (paper 3, eq. 12).
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::nn {

/// A_n, [N, K, K], of numbers [N, K, K - 1] without the diagonal: a softmax each row, nothing on the
/// diagonal.
torch::Tensor affinities_of(const torch::Tensor& free);
/// A_n as the tree of affinities reads them (retarget/marionette/affinity_tree).
std::vector<RowMatrix> matrices_of(const torch::Tensor& affinities);

}  // namespace understudy::nn
