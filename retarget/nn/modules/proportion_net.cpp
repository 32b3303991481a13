#include "retarget/nn/modules/proportion_net.hpp"

#include "retarget/pose2d/proportion_input.hpp"

namespace understudy::nn {

ProportionNetImpl::ProportionNetImpl()
    : first(register_module("first", torch::nn::Linear(kProportionInputs, kProportionWidth))),
      second(register_module("second", torch::nn::Linear(kProportionWidth, kProportionWidth))),
      third(register_module("third", torch::nn::Linear(kProportionWidth, kProportionWidth))),
      last(register_module("last", torch::nn::Linear(kProportionWidth, 2 * kFlatBoneCount))) {}

ProportionNetImpl::Lengths ProportionNetImpl::forward(const torch::Tensor& poses) {
  const auto x = torch::relu(third(torch::relu(second(torch::relu(first(poses))))));  // [B, width]
  const auto y = last(x).view({-1, 2, kFlatBoneCount});
  return {y.select(1, 0), y.select(1, 1).clamp(kLeastLogDoubt, kMostLogDoubt)};
}

}  // namespace understudy::nn
