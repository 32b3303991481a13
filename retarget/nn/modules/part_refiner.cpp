#include "retarget/nn/modules/part_refiner.hpp"

namespace understudy::nn {

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

PartNetImpl::PartNetImpl() {
  near_ = register_module("near", Sequential(Linear(3, 64), ReLU(), Linear(64, 128), ReLU()));
  whole_ = register_module("whole", Sequential(Linear(256 + kPartContext, 256), ReLU(), Linear(256, 256)));
  head_ = register_module("head", Sequential(Linear(256 + kPartContext, 256), ReLU(), Linear(256, 128),
                                             ReLU(), Linear(128, 6 * kPartJoints)));
  place_ = register_module("place",
                           Sequential(Linear(256 + kPartContext, 128), ReLU(), Linear(128, 4 * kPartJoints)));
}

torch::Tensor PartNetImpl::forward(const torch::Tensor& points, const torch::Tensor& context) {
  const auto x = near_->forward(5.0 * points);                       // [B, N, 128]; a hand is about 0.2 long
  const auto all = torch::cat({std::get<0>(x.max(1)), context}, 1);  // [B, 128 + context]
  // One layer over (x, all) at every point; what all points share is computed once.
  const auto& mix = *whole_[0]->as<Linear>();
  const auto own = torch::linear(x, mix.weight.narrow(1, 0, x.size(2)));  // [B, N, 256]
  const auto shared = torch::linear(all, mix.weight.narrow(1, x.size(2), all.size(1)), mix.bias);
  const auto y = torch::relu(whole_[2]->as<Linear>()->forward(torch::relu(own + shared.unsqueeze(1))));
  const auto found = torch::cat({std::get<0>(y.max(1)), context}, 1);
  const auto turn = head_->forward(found).view({points.size(0), kPartJoints, 6});
  const auto place = place_->forward(found).view({points.size(0), kPartJoints, 4});
  // Untrained: no rotation, hardly any displacement, an error of 2 % of a leg.
  const auto none = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, -4.f}, points.options());
  const auto unit = torch::tensor({1.f, 1.f, 1.f, 1.f, 1.f, 1.f, .1f, .1f, .1f, 1.f}, points.options());
  return torch::cat({turn, place}, 2) * unit + none;
}

PartRefinerNetImpl::PartRefinerNetImpl() {
  static const std::array<const char*, kPartKinds> kNames = {"hand", "skull", "foot", "arm", "leg"};
  for (size_t k = 0; k < kPartKinds; ++k) nets_[k] = register_module(kNames[k], PartNet());
}

}  // namespace understudy::nn
