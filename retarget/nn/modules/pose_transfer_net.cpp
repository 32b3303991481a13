#include "retarget/nn/modules/pose_transfer_net.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kCode = 256;

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

torch::Tensor normalised(const torch::Tensor& x) {
  const auto centred = x - x.mean(1, true);
  return centred / (centred.square().mean(1, true) + 1e-5).sqrt();
}

}  // namespace

PlaceNormImpl::PlaceNormImpl(int64_t width, int64_t code) {
  scale = register_module("scale", Linear(3, width));
  shift = register_module("shift", Linear(3, width));
  pose = register_module("pose", Linear(code, width));
}

torch::Tensor PlaceNormImpl::forward(const torch::Tensor& x, const torch::Tensor& places,
                                     const torch::Tensor& code) {
  return normalised(x) * (1 + scale(places)) + shift(places) + pose(code);
}

PlaceBlockImpl::PlaceBlockImpl(int64_t from, int64_t to, int64_t code) {
  norm1 = register_module("norm1", PlaceNorm(from, code));
  norm2 = register_module("norm2", PlaceNorm(to, code));
  first = register_module("first", Linear(from, to));
  second = register_module("second", Linear(to, to));
  past = register_module("past", Linear(from, to));
}

torch::Tensor PlaceBlockImpl::forward(const torch::Tensor& x, const torch::Tensor& places,
                                      const torch::Tensor& code) {
  const auto h = first(torch::relu(norm1(x, places, code)));
  return past(x) + second(torch::relu(norm2(h, places, code)));
}

PoseTransferNetImpl::PoseTransferNetImpl() {
  each_point = register_module(
      "each_point", Sequential(Linear(3, 64), ReLU(), Linear(64, 128), ReLU(), Linear(128, 512), ReLU()));
  to_code = register_module("to_code", Sequential(Linear(512, kCode), ReLU(), Linear(kCode, kCode)));
  start = register_module("start", Linear(3, 256));
  block1 = register_module("block1", PlaceBlock(256, 256, kCode));
  block2 = register_module("block2", PlaceBlock(256, 128, kCode));
  block3 = register_module("block3", PlaceBlock(128, 64, kCode));
  finish = register_module("finish", Linear(64, 3));
}

torch::Tensor PoseTransferNetImpl::forward(const torch::Tensor& source, const torch::Tensor& rest) {
  const auto pooled = std::get<0>(each_point->forward(source).max(1));  // [B, 512]
  const auto code = to_code->forward(pooled).unsqueeze(1);              // [B, 1, 256]
  const auto x = block1(start(rest), rest, code);
  return finish(block3(block2(x, rest, code), rest, code));
}

}  // namespace understudy::nn
