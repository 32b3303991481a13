#include "retarget/nn/modules/point_transformer.hpp"

#include <algorithm>
#include <array>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kEmbedding = 32, kMlpWidth = 256;
constexpr std::array<int64_t, 3> kStages = {64, 128,
                                            256};  // their widths; each keeps a quarter of the points
constexpr int64_t kAttended = 16;                  // neighbours

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

/// Rows of x [B, N, C] named by index [B, ...] -> [B, ..., C].
torch::Tensor gather_rows(const torch::Tensor& x, const torch::Tensor& index) {
  const auto B = x.size(0), N = x.size(1);
  const auto base = torch::arange(B, index.options()).mul(N).view({B, 1});
  const auto flat = (index.view({B, -1}) + base).view({-1});
  auto shape = index.sizes().vec();
  shape.push_back(x.size(2));
  return x.reshape({B * N, -1}).index_select(0, flat).view(shape);
}

Points points_of(const torch::Tensor& cloud) {  // [N, 3]
  const auto c = cloud.detach().cpu().contiguous();
  return Eigen::Map<const Points>(c.data_ptr<float>(), c.size(0), 3);
}

/// Which `count` points of each cloud are kept: those far apart, [B, count].
torch::Tensor far_apart(const torch::Tensor& positions, int64_t count) {
  auto kept = torch::empty({positions.size(0), count}, torch::kInt64);
  for (int64_t b = 0; b < positions.size(0); ++b) {
    const Points cloud = points_of(positions[b]);
    Eigen::Index first;  // the order of the points must not matter
    (cloud.rowwise() - cloud.colwise().mean()).rowwise().squaredNorm().minCoeff(&first);
    const auto chosen = farthest_points(cloud, count, first);
    std::copy(chosen.begin(), chosen.end(), kept[b].data_ptr<int64_t>());
  }
  return kept.to(positions.device());
}

torch::Tensor nearest(const torch::Tensor& points, const torch::Tensor& queries, int64_t k) {  // [B, Q, k]
  return std::get<1>(torch::cdist(queries, points).topk(k, -1, /*largest=*/false));
}

}  // namespace

VectorAttentionImpl::VectorAttentionImpl(int64_t width) {
  phi = register_module("phi", Linear(width, width));
  psi = register_module("psi", Linear(width, width));
  alpha = register_module("alpha", Linear(width, width));
  out = register_module("out", Linear(width, width));
  gamma = register_module("gamma", Sequential(Linear(width, width), ReLU(), Linear(width, width)));
  theta = register_module("theta", Sequential(Linear(3, width), ReLU(), Linear(width, width)));
  norm = register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})));
}

torch::Tensor VectorAttentionImpl::forward(const torch::Tensor& x, const torch::Tensor& positions,
                                           const torch::Tensor& neighbours) {
  const auto h = norm(x);
  // [B, N, k, C]
  const auto delta = theta->forward(positions.unsqueeze(2) - gather_rows(positions, neighbours));
  // [B, N, k, C]
  const auto weight = gamma->forward(phi(h).unsqueeze(2) - gather_rows(psi(h), neighbours) + delta);
  const auto value = gather_rows(alpha(h), neighbours) + delta;  // [B, N, k, C]
  return x + out((torch::softmax(weight, 2) * value).sum(2));    // [B, N, C]
}

PointTransformerImpl::PointTransformerImpl() {
  const auto& w = kStages;
  embed = register_module("embed", Sequential(Linear(3, kEmbedding), ReLU()));
  attention = register_module("attention", torch::nn::ModuleList());
  widen = register_module("widen", torch::nn::ModuleList());
  for (size_t i = 0; i < w.size(); ++i) {
    widen->push_back(Linear((i == 0 ? kEmbedding : w[i - 1]) + 3, w[i]));
    attention->push_back(VectorAttention(w[i]));
  }
  head = register_module(
      "head", Sequential(Linear(2 * w.back(), kMlpWidth), ReLU(), Linear(kMlpWidth, kMlpWidth), ReLU(),
                         Linear(kMlpWidth, 3 * kJointCount)));
}

torch::Tensor PointTransformerImpl::forward(const torch::Tensor& points) {
  auto positions = points;
  auto x = embed->forward(points);  // [B, N, C]
  for (size_t i = 0; i < kStages.size(); ++i) {
    // Transition down: a quarter of the points, each the maximum over its neighbourhood.
    const auto kept = far_apart(positions, positions.size(1) / 4);              // [B, N/4]
    const auto centres = gather_rows(positions, kept);                          // [B, N/4, 3]
    const auto around = nearest(positions, centres, kAttended);                 // [B, N/4, k]
    const auto offset = gather_rows(positions, around) - centres.unsqueeze(2);  // [B, N/4, k, 3]
    const auto wide =
        torch::relu(widen[i]->as<Linear>()->forward(torch::cat({gather_rows(x, around), offset}, -1)));
    x = std::get<0>(wide.max(2));
    positions = centres;
    const auto neighbours = nearest(positions, positions, std::min(kAttended, positions.size(1)));
    x = attention[i]->as<VectorAttention>()->forward(x, positions, neighbours);
  }
  const auto pooled = torch::cat({x.mean(1), std::get<0>(x.max(1))}, -1);  // [B, 2C]
  return head->forward(pooled).view({-1, kJointCount, 3});
}

}  // namespace understudy::nn
