#include "retarget/nn/modules/point_gains_net.hpp"

#include <algorithm>
#include <vector>

#include "retarget/keypoints/point_filter.hpp"

namespace understudy::nn {
namespace {

torch::Tensor norm_of(const torch::Tensor& ways) {
  return ways.square().sum(-1, true).add(1e-8).sqrt();
}

torch::Tensor along(const torch::Tensor& a, const torch::Tensor& b) {
  return (a * b).sum(-1, true);
}

/// [B, P, ...]: PointFilter's after a frame.
struct PointStates {
  torch::Tensor x, v, shown, off, hidden, show_gain, carry_gain, age;
};

/// One frame of the sightings, [B, P, ...].
struct PointFrame {
  torch::Tensor places, is_seen, sigma, size, dt;
};

/// Where points have gone by then, seen or not.
torch::Tensor ahead_of(const PointStates& s, const PointFrame& frame) {
  const auto coasting = PointFilter::kCoasting * (1 - torch::exp(-frame.dt / PointFilter::kCoasting));
  return s.x + torch::where(frame.is_seen > 0, frame.dt, coasting) * s.v;
}

torch::Tensor features_of(const PointStates& s, const PointFrame& frame, const torch::Tensor& ahead,
                          const torch::Tensor& off, const torch::Tensor& age) {
  const auto flat = torch::zeros_like(age);
  const auto way = frame.dt * s.v / frame.sigma, lag = (ahead - s.shown) / frame.sigma;
  return torch::cat(
      {torch::log1p(norm_of(off)), torch::asinh(along(off, s.off)),
       torch::asinh(along(off, way) / norm_of(way)), torch::asinh(along(off, lag)),
       torch::log1p(norm_of(way)), torch::log1p(norm_of(lag)), torch::log(frame.sigma / frame.size) + 5,
       flat + torch::log1p(norm_of(s.off)).mean(1, true), torch::exp(-PointFilter::kAgeScale * age),
       torch::log(PointFilter::kUsualRate * (flat + frame.dt))},
      -1);
}

}  // namespace

PointGainsNetImpl::PointGainsNetImpl()
    : memory(register_module("memory", torch::nn::GRUCell(kGainFeatures, kGainHidden))),
      out(register_module("out", torch::nn::Linear(kGainHidden, kGains))) {
  const torch::NoGradGuard no_grad;
  out->bias.copy_(torch::tensor({0.0f, -1.5f, 1.0f, -1.0f}));  // half, a fifth, most, a quarter
}

torch::Tensor PointGainsNetImpl::forward(const SeenPoints& seen) {
  const auto first = seen.places.select(1, 0);
  const auto zero = torch::zeros_like(first), flat = torch::zeros_like(first.slice(-1, 0, 1));
  PointStates s{first,    zero, first, zero, first.new_zeros({first.size(0) * first.size(1), kGainHidden}),
                flat + 1, flat, flat};
  std::vector<torch::Tensor> shown{first};
  for (int64_t t = 1; t < seen.places.size(1); ++t) {
    const PointFrame frame{seen.places.select(1, t), seen.is_seen.select(1, t).unsqueeze(-1),
                           seen.sigma.select(1, t).unsqueeze(-1), seen.size.select(1, t).view({-1, 1, 1}),
                           seen.dt.view({-1, 1, 1})};
    const auto is = frame.is_seen > 0;
    const auto ahead = ahead_of(s, frame);
    const auto off = (frame.places - ahead) / frame.sigma;
    s.age = torch::relu(s.age + torch::where(is, frame.dt, -PointFilter::kForgottenUnseen * frame.dt));
    const auto hidden = memory(features_of(s, frame, ahead, off, s.age).flatten(0, 1), s.hidden);
    const auto gains = torch::sigmoid(out(hidden)).view({first.size(0), first.size(1), kGains});
    s.hidden = torch::where(is.flatten(0, 1), hidden, s.hidden);
    const auto coasted = ahead - s.x;
    s.x = torch::where(is, ahead + gains.slice(-1, 0, 1) * frame.sigma * off, ahead);
    s.v = torch::where(is, s.v + gains.slice(-1, 1, 2) * frame.sigma / frame.dt * off,
                       s.v * torch::exp(-frame.dt / PointFilter::kCoasting));
    s.off = torch::where(is, off, s.off);
    s.show_gain = torch::where(is, gains.slice(-1, 2, 3), s.show_gain);
    s.carry_gain = torch::where(is, gains.slice(-1, 3, 4), s.carry_gain);
    s.shown = s.shown + s.carry_gain * torch::where(is, frame.dt * s.v, coasted);
    s.shown = s.shown + s.show_gain * (s.x - s.shown);
    shown.push_back(s.shown);
  }
  return torch::stack(shown, 1);
}

std::array<float, kGainNumbers> PointGainsNetImpl::numbers() const {
  std::vector<torch::Tensor> all;
  for (const auto& parameter : parameters()) all.push_back(parameter.detach().cpu().flatten());
  const auto flat = torch::cat(all).contiguous();
  std::array<float, kGainNumbers> numbers{};
  std::copy_n(flat.data_ptr<float>(), numbers.size(), numbers.begin());
  return numbers;
}

void PointGainsNetImpl::set_numbers(const std::array<float, kGainNumbers>& numbers) {
  const torch::NoGradGuard no_grad;
  int64_t at = 0;
  const auto flat = torch::tensor(std::vector<float>(numbers.begin(), numbers.end()));
  for (auto& parameter : parameters()) {
    parameter.copy_(flat.slice(0, at, at + parameter.numel()).view(parameter.sizes()));
    at += parameter.numel();
  }
}

}  // namespace understudy::nn
