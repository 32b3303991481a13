#include "retarget/nn/modules/step_cvae.hpp"

#include <vector>

namespace understudy::nn {
namespace {

using torch::nn::Linear;

constexpr double kLeastBone = 0.01;    // metres: some skeletons have joints in one place
constexpr double kMostVariance = 8;    // logarithm, both ways
constexpr double kFirstVariance = -4;  // logarithm
constexpr double kBoneScale = 5;       // a bone a fifth longer is as much as 1

/// Logarithms of the mean lengths of both sides' bones, [B, 22, 3] -> [B, kBoneNumbers].
torch::Tensor bones_of(const torch::Tensor& rest) {
  std::vector<torch::Tensor> bones;
  const auto length = [&rest](int joint) {
    return (rest.select(1, joint) - rest.select(1, kParents[joint])).norm(2, -1);
  };
  for (int joint = 1; joint < kJointCount; ++joint)
    if (kMirror[joint] >= joint) bones.push_back(0.5 * (length(joint) + length(kMirror[joint])));
  return torch::stack(bones, -1).clamp_min(kLeastBone).log();
}

}  // namespace

StepCvaeImpl::StepCvaeImpl(const StepCvaeOptions& options) : options_(options) {
  const int64_t w = options.width, code = options.code, told = options.told ? kBoneNumbers : 0;
  encoder1 = register_module("encoder1", Linear(kStepNumbers, w));
  encoder2 = register_module("encoder2", Linear(w, w));
  encoder3 = register_module("encoder3", Linear(w, 2 * code));
  decoder1 = register_module("decoder1", Linear(code + told, w));
  decoder2 = register_module("decoder2", Linear(w, w));
  decoder3 = register_module("decoder3", Linear(w, kStepNumbers));
  straight_to_codes = register_module("straight_to_codes", Linear(kStepNumbers, code));
  straight_to_movements = register_module("straight_to_movements", Linear(code, kStepNumbers));
  usual_bones = register_buffer("usual_bones", torch::zeros({kBoneNumbers}));
  usual_times = register_buffer("usual_times", torch::zeros({kStepTimes}));
}

void StepCvaeImpl::set_usual(const torch::Tensor& rest, double seconds) {
  const torch::NoGradGuard no_grad;
  usual_bones.copy_(bones_of(rest.unsqueeze(0)).squeeze(0));
  usual_times.copy_(torch::linspace(0, seconds / kStepSeconds, kStepTimes));
}

void StepCvaeImpl::begin_linear(const torch::Tensor& mean, const torch::Tensor& to_codes,
                                const torch::Tensor& to_movements) {
  const torch::NoGradGuard no_grad;
  straight_to_codes->weight.copy_(to_codes);
  straight_to_codes->bias.copy_(-torch::mv(to_codes, mean));
  straight_to_movements->weight.copy_(to_movements);
  straight_to_movements->bias.copy_(mean);
  for (auto& layer : {encoder3, decoder3}) {
    layer->weight.zero_();
    layer->bias.zero_();
  }
  encoder3->bias.slice(0, options_.code).fill_(kFirstVariance);
}

StepCodes StepCvaeImpl::encode(const torch::Tensor& movements) {
  const int64_t untimed = kStepNumbers - kStepTimes;
  const auto seen =
      options_.timed
          ? movements
          : torch::cat({movements.slice(1, 0, untimed), torch::zeros_like(movements.slice(1, untimed))}, 1);
  const auto out = encoder3(torch::relu(encoder2(torch::relu(encoder1(seen)))));  // [B, 2 code]
  return {straight_to_codes(seen) + out.slice(1, 0, options_.code),
          out.slice(1, options_.code).clamp(-kMostVariance, kMostVariance)};
}

torch::Tensor StepCvaeImpl::decode(const torch::Tensor& codes, const torch::Tensor& rest) {
  const auto seen =
      options_.told ? torch::cat({codes, kBoneScale * (bones_of(rest) - usual_bones)}, 1) : codes;
  const auto made =
      straight_to_movements(codes) + decoder3(torch::relu(decoder2(torch::relu(decoder1(seen)))));
  if (options_.timed) return made;
  return torch::cat(
      {made.slice(1, 0, kStepNumbers - kStepTimes), usual_times.expand({made.size(0), kStepTimes})}, 1);
}

}  // namespace understudy::nn
