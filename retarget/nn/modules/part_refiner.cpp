#include "retarget/nn/modules/part_refiner.hpp"

namespace understudy::nn {
namespace {

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

constexpr int64_t kSeen = 256;  // numbers that a part is described by, beside its context
constexpr int64_t kWidth = 128, kHeads = 4, kLayers = 3;  // of patches

}  // namespace

PartNetImpl::PartNetImpl() {
  const int64_t seen = kSeen + kPartContext;
  head_ = register_module(
      "head", Sequential(Linear(seen, 256), ReLU(), Linear(256, 128), ReLU(), Linear(128, 6 * kPartJoints)));
  place_ = register_module("place", Sequential(Linear(seen, 128), ReLU(), Linear(128, 4 * kPartJoints)));
}

torch::Tensor PartNetImpl::forward(const torch::Tensor& points, const torch::Tensor& context) {
  const auto found = torch::cat({look(points, context), context}, 1);
  const auto turn = head_->forward(found).view({points.size(0), kPartJoints, 6});
  const auto place = place_->forward(found).view({points.size(0), kPartJoints, 4});
  // Untrained: no rotation, hardly any displacement, an error of 2 % of a leg.
  const auto none = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, -4.f}, points.options());
  const auto unit = torch::tensor({1.f, 1.f, 1.f, 1.f, 1.f, 1.f, .1f, .1f, .1f, 1.f}, points.options());
  return torch::cat({turn, place}, 2) * unit + none;
}

PlainPartNetImpl::PlainPartNetImpl() {
  near_ = register_module("near", Sequential(Linear(3, 64), ReLU(), Linear(64, 128), ReLU()));
  whole_ =
      register_module("whole", Sequential(Linear(256 + kPartContext, kSeen), ReLU(), Linear(kSeen, kSeen)));
}

torch::Tensor PlainPartNetImpl::look(const torch::Tensor& points, const torch::Tensor& context) {
  const auto x = near_->forward(5.0 * points);                       // [B, N, 128]; a hand is about 0.2 long
  const auto all = torch::cat({std::get<0>(x.max(1)), context}, 1);  // [B, 128 + context]
  // One layer over (x, all) at every point; what all points share is computed once.
  const auto& mix = *whole_[0]->as<Linear>();
  const auto own = torch::linear(x, mix.weight.narrow(1, 0, x.size(2)));  // [B, N, 256]
  const auto shared = torch::linear(all, mix.weight.narrow(1, x.size(2), all.size(1)), mix.bias);
  const auto y = torch::relu(whole_[2]->as<Linear>()->forward(torch::relu(own + shared.unsqueeze(1))));
  return std::get<0>(y.max(1));
}

PatchPartNetImpl::PatchPartNetImpl() {
  patch_mlp_ = register_module("patch_mlp", Sequential(Linear(3, 64), ReLU(), Linear(64, 128), ReLU()));
  patch_out_ = register_module("patch_out", Linear(128, kWidth));
  position_mlp_ =
      register_module("position_mlp", Sequential(Linear(3, kWidth), ReLU(), Linear(kWidth, kWidth)));
  told_ = register_module("told", Linear(kPartContext, kWidth));
  encoder_ = register_module("encoder", torch::nn::ModuleList());
  for (int64_t i = 0; i < kLayers; ++i) encoder_->push_back(EncoderLayer(kWidth, kHeads));
  norm_ = register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({kWidth})));
  widen_ = register_module("widen", Linear(kWidth, kSeen));
}

torch::Tensor PatchPartNetImpl::look(const torch::Tensor& points, const torch::Tensor& context) {
  const auto B = points.size(0);
  const auto centres = points.narrow(1, 0, kPartPatches),
             offsets = points.narrow(1, kPartPatches, kPartPatches * kPartPatchPoints);
  // A patch is about 0.05 wide, a hand 0.2 long.
  const auto near = patch_mlp_->forward(20.0 * offsets);  // [B, M * K, 128]
  const auto pooled = std::get<0>(near.view({B, kPartPatches, kPartPatchPoints, -1}).max(2));
  const auto at = 5.0 * centres, position = position_mlp_->forward(at), squared = squared_distance(at, at);
  auto x = patch_out_(pooled) + position + told_(context).unsqueeze(1);  // [B, M, width]
  for (const auto& layer : *encoder_) x = layer->as<EncoderLayer>()->forward(x, position, squared);
  return std::get<0>(torch::relu(widen_(norm_(x))).max(1));
}

PartRefinerNetImpl::PartRefinerNetImpl() {
  for (size_t k = 0; k < kPartKinds; ++k) {
    if (seen_in_patches(static_cast<PartKind>(k)))
      nets_[k] = register_module(kPartNames[k], std::make_shared<PatchPartNetImpl>());
    else
      nets_[k] = register_module(kPartNames[k], std::make_shared<PlainPartNetImpl>());
  }
}

}  // namespace understudy::nn
