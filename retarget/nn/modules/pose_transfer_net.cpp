#include "retarget/nn/modules/pose_transfer_net.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kCode = 256;

using torch::nn::Linear, torch::nn::ReLU, torch::nn::Sequential;

torch::Tensor normalised(const torch::Tensor& x, int64_t counted) {
  const auto centred = x - x.narrow(1, 0, counted).mean(1, true);
  return centred / (centred.narrow(1, 0, counted).square().mean(1, true) + 1e-5).sqrt();
}

}  // namespace

PlaceNormImpl::PlaceNormImpl(int64_t width, int64_t code) {
  scale = register_module("scale", Linear(3, width));
  shift = register_module("shift", Linear(3, width));
  pose = register_module("pose", Linear(code, width));
}

torch::Tensor PlaceNormImpl::forward(const torch::Tensor& x, const torch::Tensor& places,
                                     const torch::Tensor& code, int64_t counted) {
  return normalised(x, counted) * (1 + scale(places)) + shift(places) + pose(code);
}

PlaceBlockImpl::PlaceBlockImpl(int64_t from, int64_t to, int64_t code) {
  norm1 = register_module("norm1", PlaceNorm(from, code));
  norm2 = register_module("norm2", PlaceNorm(to, code));
  first = register_module("first", Linear(from, to));
  second = register_module("second", Linear(to, to));
  past = register_module("past", Linear(from, to));
}

torch::Tensor PlaceBlockImpl::forward(const torch::Tensor& x, const torch::Tensor& places,
                                      const torch::Tensor& code, int64_t counted) {
  const auto h = first(torch::relu(norm1(x, places, code, counted)));
  return past(x) + second(torch::relu(norm2(h, places, code, counted)));
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

torch::Tensor PoseTransferNetImpl::forward(const torch::Tensor& source, const torch::Tensor& rest,
                                           int64_t counted) {
  if (counted < 0) counted = rest.size(1);
  const auto pooled = std::get<0>(each_point->forward(source).max(1));  // [B, 512]
  const auto code = to_code->forward(pooled).unsqueeze(1);              // [B, 1, 256]
  const auto x = block1(start(rest), rest, code, counted);
  return finish(block3(block2(x, rest, code, counted), rest, code, counted));
}

}  // namespace understudy::nn
