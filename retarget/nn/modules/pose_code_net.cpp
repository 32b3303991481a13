#include "retarget/nn/modules/pose_code_net.hpp"

#include "retarget/pose2d/pose_code.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kJudgeWidth = 256;

torch::nn::Linear linear(torch::nn::Module& of, const std::string& name, int64_t from, int64_t to) {
  return of.register_module(name, torch::nn::Linear(from, to));
}

/// Each channel with mean 0 and variance 1 over the points, [B, 15, C].
torch::Tensor normalised(const torch::Tensor& x) {
  const auto away = x - x.mean(1, true);
  return away * torch::rsqrt(away.square().mean(1, true) + static_cast<double>(kCodeVariance));
}

}  // namespace

CodeLayerImpl::CodeLayerImpl(int64_t width)
    : mix(register_parameter("mix",
                             torch::eye(kPaperPoints) + 0.1 * torch::randn({kPaperPoints, kPaperPoints}))),
      within(linear(*this, "within", width, width)) {}

torch::Tensor CodeLayerImpl::forward(const torch::Tensor& x) {
  return within(torch::matmul(mix, x));
}

namespace {

/// Modules whose parameters are called as in the weights file: "pose.block0.mix".
struct Part : torch::nn::Module {};

std::shared_ptr<torch::nn::Module> part(torch::nn::Module& of, const std::string& name) {
  return of.register_module(name, std::make_shared<Part>());
}

}  // namespace

PoseCodeGeneratorImpl::PoseCodeGeneratorImpl()
    : in(nullptr),
      code(nullptr),
      first(nullptr),
      second(nullptr),
      person(nullptr),
      style(nullptr),
      styles(nullptr),
      out(nullptr),
      points(nullptr) {
  const auto pose = part(*this, "pose"), who = part(*this, "person"), adapt = part(*this, "style"),
             decode = part(*this, "decoder"), end = part(*this, "out");
  in = linear(*pose, "first", kPoseCodeInputs, kPoseCodeWidth);
  code = linear(*pose, "last", kPoseCodeWidth, kPoseDecoderWidth);
  first = linear(*who, "first", kFlatBoneCount, kPersonHidden);
  second = linear(*who, "second", kPersonHidden, kPersonHidden);
  person = linear(*who, "last", kPersonHidden, kPersonCodeWidth);
  style = linear(*adapt, "first", kPersonCodeWidth, kPersonHidden);
  styles = linear(*adapt, "last", kPersonHidden, 4 * kPoseCodeBlocks * kPoseDecoderWidth);
  out = linear(*end, "first", kPoseDecoderWidth, kPoseCodeWidth);
  points = linear(*end, "last", kPoseCodeWidth, 2);
  for (int k = 0; k < kPoseCodeBlocks; ++k) {
    encoder.push_back(pose->register_module("block" + std::to_string(k), CodeLayer(kPoseCodeWidth)));
    decoder.push_back(decode->register_module("first" + std::to_string(k), CodeLayer(kPoseDecoderWidth)));
    decoder.push_back(decode->register_module("second" + std::to_string(k), CodeLayer(kPoseDecoderWidth)));
  }
}

torch::Tensor PoseCodeGeneratorImpl::forward(const torch::Tensor& poses, const torch::Tensor& people) {
  auto x = in(poses);
  for (auto& block : encoder) x = x + torch::relu(normalised(block(x)));
  x = code(x);  // [B, 15, decoder]
  const auto who = person(torch::relu(second(torch::relu(first(people)))));
  const auto adapted = styles(torch::relu(style(who))).view({-1, 4 * kPoseCodeBlocks, 1, kPoseDecoderWidth});
  for (int k = 0; k < kPoseCodeBlocks; ++k) {
    auto y = x;
    for (int half = 0; half < 2; ++half) {
      const int row = 4 * k + 2 * half;
      y = normalised(decoder[static_cast<size_t>(2 * k + half)](y));
      y = y * (1 + adapted.select(1, row)) + adapted.select(1, row + 1);
      if (half == 0) y = torch::relu(y);
    }
    x = x + y;
  }
  return points(torch::relu(out(x)));
}

PoseCodeDiscriminatorImpl::PoseCodeDiscriminatorImpl(int64_t people)
    : first(linear(*this, "first", 2 * kPaperPoints, kJudgeWidth)),
      second(linear(*this, "second", kJudgeWidth, kJudgeWidth)),
      third(linear(*this, "third", kJudgeWidth, kJudgeWidth)),
      last(linear(*this, "last", kJudgeWidth, people)) {}

PoseCodeDiscriminatorImpl::Judged PoseCodeDiscriminatorImpl::forward(const torch::Tensor& poses) {
  const auto middle = (poses.amax(1, true) + poses.amin(1, true)) / 2;
  auto x = (poses - middle).flatten(1);
  const auto leaky = [](const torch::Tensor& y) { return torch::leaky_relu(y, 0.2); };
  x = leaky(third(leaky(second(leaky(first(x))))));
  return {last(x), x};
}

}  // namespace understudy::nn
