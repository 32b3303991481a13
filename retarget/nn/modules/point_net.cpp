#include "retarget/nn/modules/point_net.hpp"

#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

PointNetImpl::PointNetImpl() {
  each_point = register_module("each_point", Sequential(Linear(3, 64), ReLU(), Linear(64, 64), ReLU(),
                                                        Linear(64, 128), ReLU(), Linear(128, 1024), ReLU()));
  head = register_module(
      "head", Sequential(Linear(1024, 512), ReLU(), Linear(512, 256), ReLU(), Linear(256, 3 * kJointCount)));
}

torch::Tensor PointNetImpl::forward(const torch::Tensor& points) {
  const auto features = each_point->forward(points);                              // [B, N, 1024]
  return head->forward(std::get<0>(features.max(1))).view({-1, kJointCount, 3});  // amax is slower backward
}

}  // namespace understudy::nn
