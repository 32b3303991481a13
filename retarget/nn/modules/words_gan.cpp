#include "retarget/nn/modules/words_gan.hpp"

#include <cmath>

namespace understudy::nn {
namespace F = torch::nn::functional;

JointConvImpl::JointConvImpl(int64_t joints, int64_t in, int64_t out, int64_t size, int64_t stride,
                             double gain)
    : size_(size), stride_(stride) {
  const double spread = gain * std::sqrt(2.0 / static_cast<double>(size * in));
  weight = register_parameter("weight", spread * torch::randn({joints, size * in, out}));
  bias = register_parameter("bias", torch::zeros({joints, 1, out}));
}

torch::Tensor JointConvImpl::forward(const torch::Tensor& x) {
  const int64_t batch = x.size(0), joints = x.size(1), channels = x.size(3), half = size_ / 2;
  // The ends are repeated: a word goes on beyond them.
  const auto before = x.narrow(2, 0, 1).expand({batch, joints, half, channels}),
             after = x.narrow(2, x.size(2) - 1, 1).expand({batch, joints, half, channels});
  const auto windows = torch::cat({before, x, after}, 2).unfold(2, size_, stride_);  // [B, J, T', C, size]
  const int64_t times = windows.size(2);
  const auto flat = windows.permute({1, 0, 2, 4, 3}).reshape({joints, batch * times, size_ * channels});
  const auto made = torch::baddbmm(bias, flat, weight);
  return made.view({joints, batch, times, made.size(2)}).transpose(0, 1);
}

namespace {

/// Two convolutions beside a straight way.
class WordBlockImpl : public torch::nn::Module {
 public:
  WordBlockImpl(int64_t joints, int64_t width)
      : one(register_module("one", JointConv(joints, width, width, 3))),
        two(register_module("two", JointConv(joints, width, width, 3, 1, 0.1))) {}
  torch::Tensor forward(const torch::Tensor& x) { return x + two(torch::relu(one(x))); }

 private:
  JointConv one, two;
};

torch::Tensor doubled(const torch::Tensor& x, int64_t times) {
  return x.repeat_interleave(2, 2).narrow(2, 0, times);
}

}  // namespace

WordGeneratorImpl::WordGeneratorImpl(const WordsOptions& options) : options_(options) {
  const bool each = options.joint_wise;
  const int64_t joints = each ? options.joints : 1, in = each ? 4 : 4 * options.joints,
                w = each ? options.width : 4 * options.width;
  first = register_module("first", JointConv(joints, in, w, 7));
  down1 = register_module("down1", JointConv(joints, w, 2 * w, 3, 2));
  down2 = register_module("down2", JointConv(joints, 2 * w, 4 * w, 3, 2));
  for (int64_t i = 0; i < options.blocks; ++i)
    blocks->push_back(std::make_shared<WordBlockImpl>(joints, 4 * w));
  register_module("blocks", blocks);
  up1 = register_module("up1", JointConv(joints, 4 * w, 2 * w, 3));
  up2 = register_module("up2", JointConv(joints, 2 * w, w, 3));
  last = register_module("last", JointConv(joints, w, in, 7, 1, 0.01));
}

torch::Tensor WordGeneratorImpl::forward(const torch::Tensor& words) {
  const int64_t batch = words.size(0), times = words.size(1);
  const auto x = options_.joint_wise ? words.view({batch, times, options_.joints, 4}).transpose(1, 2)
                                     : words.unsqueeze(1);
  auto y = torch::relu(first(x));
  const auto half = torch::relu(down1(y));
  y = torch::relu(down2(half));
  for (const auto& block : *blocks) y = block->as<WordBlockImpl>()->forward(y);
  y = torch::relu(up1(doubled(y, half.size(2))));
  y = torch::relu(up2(doubled(y, times)));
  y = x + last(y);
  return options_.joint_wise ? y.transpose(1, 2).reshape({batch, times, 4 * options_.joints}) : y.squeeze(1);
}

WordDiscriminatorImpl::WordDiscriminatorImpl(int64_t joints) {
  const auto conv = [](int64_t in, int64_t out, int64_t stride) {
    return torch::nn::Conv1d(torch::nn::Conv1dOptions(in, out, 4).stride(stride).padding(2));
  };
  const auto leaky = [] { return torch::nn::LeakyReLU(torch::nn::LeakyReLUOptions().negative_slope(0.2)); };
  layers = register_module("layers", torch::nn::Sequential(conv(4 * joints, 64, 2), leaky(), conv(64, 128, 2),
                                                           leaky(), conv(128, 256, 2), leaky(),
                                                           conv(256, 512, 1), leaky(), conv(512, 1, 1)));
}

torch::Tensor WordDiscriminatorImpl::forward(const torch::Tensor& words) {
  return layers->forward(words.transpose(1, 2)).flatten(1);
}

}  // namespace understudy::nn
