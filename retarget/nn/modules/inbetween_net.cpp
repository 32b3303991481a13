#include "retarget/nn/modules/inbetween_net.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/modules/motion_gru.hpp"

namespace understudy::nn {
namespace {

using torch::nn::LayerNorm, torch::nn::LayerNormOptions, torch::nn::Linear, torch::nn::LinearOptions;

constexpr int64_t kMostApart = 64;  // frames between two that are still told apart
constexpr int64_t kTurns = 6 * kJointCount;
constexpr int64_t kOutputs = kTurns + 3 + 2 + 1;  // turns, root, standing feet, doubt
// turns, root, joints and their velocities, what is known, how far it is
constexpr int64_t kInputs = kTurns + 3 + 2 * 3 * kJointCount + kPartCount + 12;
constexpr double kVelocityScale = 10;   // legs a frame
constexpr double kFirstDeviation = -2;  // logarithm of a code's, before training: codes are to tell something
constexpr double kCorrection = 0.5;     // of an output of 1, half a second from what is known

/// How near known frames are, at three scales, [B, T, 2] -> [B, T, 6].
torch::Tensor nearness_of(const torch::Tensor& distance) {
  return torch::cat({(-distance / 3).exp(), (-distance / 12).exp(), (-distance / 40).exp()}, -1);
}

/// 6D forms less the identity's.
torch::Tensor turns_of(const torch::Tensor& rotations) {
  return rotations_to_6d(rotations) - torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, rotations.options());
}

/// The same windows in a mirror.
InbetweenInput mirrored(const InbetweenInput& input) {
  std::vector<int64_t> mirror(kMirror.begin(), kMirror.end());
  mirror.push_back(kRootPart);
  const auto parts = torch::tensor(mirror).to(input.root.device()), sides = parts.slice(0, 0, kJointCount);
  const auto across = torch::tensor({-1.f, 1.f, 1.f}, input.root.options());
  return {input.rotations.index_select(2, sides) * across.unsqueeze(1) * across, input.root * across,
          input.distance.index_select(2, parts), input.rest.index_select(1, sides) * across};
}

}  // namespace

torch::Tensor code_in_mirror(const torch::Tensor& code) {
  const int64_t half = code.size(-1) / 2;
  return torch::cat({code.slice(-1, 0, half), -code.slice(-1, half)}, -1);
}

WindowTransformerImpl::WindowTransformerImpl(const WindowLayers& form, int64_t outputs) : form_(form) {
  const int64_t w = form.width;
  const auto norm = [&] { return LayerNorm(LayerNormOptions({w})); };
  embed = register_module("embed", Linear(kInputs, w));
  attention_norm = register_module("attention_norm", torch::nn::ModuleList());
  query_key_value = register_module("query_key_value", torch::nn::ModuleList());
  mixed = register_module("mixed", torch::nn::ModuleList());
  inner_norm = register_module("inner_norm", torch::nn::ModuleList());
  widen = register_module("widen", torch::nn::ModuleList());
  narrow = register_module("narrow", torch::nn::ModuleList());
  by_distance = register_module("by_distance", torch::nn::ParameterList());
  for (int64_t i = 0; i < form.layers; ++i) {
    attention_norm->push_back(norm());
    query_key_value->push_back(Linear(w, 3 * w));
    mixed->push_back(Linear(w, w));
    inner_norm->push_back(norm());
    widen->push_back(Linear(w, form.inner));
    narrow->push_back(Linear(form.inner, w));
    by_distance->append(torch::zeros({form.heads, 2 * kMostApart + 1}, torch::requires_grad()));
  }
  last_norm = register_module("last_norm", norm());
  head = register_module("head", Linear(w, outputs));
}

torch::Tensor WindowTransformerImpl::features(const InbetweenInput& input) const {
  const auto leg = leg_lengths(input.rest).view({-1, 1, 1});
  const auto around = forward_kinematics(input.rest, input.rotations).joints.flatten(2) / leg;  // [B, T, 66]
  const auto root = input.root / leg;
  const auto placed = around + root.repeat({1, 1, kJointCount});
  const auto velocity = kVelocityScale * (placed.slice(1, 1) - placed.slice(1, 0, -1));
  const auto moving = torch::cat({velocity, velocity.slice(1, -1)}, 1);
  const auto known = (input.distance.amax(-1) == 0).to(root.dtype());  // [B, T, 23]
  const auto of_root = nearness_of(input.distance.select(2, kRootPart));
  const auto of_farthest = nearness_of(input.distance.amax(2));
  return torch::cat({turns_of(input.rotations).flatten(2), root, around, moving, known, of_root, of_farthest},
                    -1);
}

/// What attention adds for frames so far apart, [heads, T, T].
torch::Tensor WindowTransformerImpl::nearness(int64_t frames, size_t layer) const {
  const auto table = by_distance->parameters()[layer];
  const auto at = torch::arange(frames, torch::TensorOptions(torch::kLong).device(table.device()));
  const auto apart = (at.unsqueeze(0) - at.unsqueeze(1)).clamp(-kMostApart, kMostApart) + kMostApart;
  return table.index_select(1, apart.flatten()).view({form_.heads, frames, frames});
}

torch::Tensor WindowTransformerImpl::attended(const torch::Tensor& x, size_t layer) {
  const int64_t batch = x.size(0), frames = x.size(1), heads = form_.heads, w = form_.width / heads;
  const auto all = query_key_value[layer]->as<Linear>()->forward(x).view({batch, frames, 3, heads, w});
  const auto part = [&](int64_t i) { return all.select(2, i).transpose(1, 2); };  // [B, heads, T, w]
  const auto likeness = torch::matmul(part(0), part(1).transpose(-1, -2)) / std::sqrt(double(w));
  const auto share = torch::softmax(likeness + nearness(frames, layer), -1);
  const auto seen = torch::matmul(share, part(2)).transpose(1, 2).reshape({batch, frames, form_.width});
  return mixed[layer]->as<Linear>()->forward(seen);
}

torch::Tensor WindowTransformerImpl::forward(const InbetweenInput& input, const torch::Tensor& added) {
  auto x = embed(features(input));
  if (added.defined()) x = x + added;
  for (size_t i = 0; i < static_cast<size_t>(form_.layers); ++i) {
    x = x + attended(attention_norm[i]->as<LayerNorm>()->forward(x), i);
    const auto inner = widen[i]->as<Linear>()->forward(inner_norm[i]->as<LayerNorm>()->forward(x));
    x = x + narrow[i]->as<Linear>()->forward(torch::gelu(inner));
  }
  return head(last_norm(x));
}

InbetweenNetImpl::InbetweenNetImpl(const InbetweenOptions& options)
    : WindowTransformerImpl(options, kOutputs), code_size_(options.code) {
  movement_encoder =
      register_module("movement_encoder", WindowTransformer(options.encoder, 2 * options.code));
  movement_told =
      register_module("movement_told", Linear(LinearOptions(options.code + 1, options.width).bias(false)));
  const torch::NoGradGuard no_grad;
  head->weight.zero_();
  head->bias.zero_();
}

MovementCode InbetweenNetImpl::encode(InbetweenInput movement) {
  movement.distance = torch::zeros_like(movement.distance);
  const auto half = [this](const InbetweenInput& seen) {
    return movement_encoder->forward(seen).mean(1).split(code_size_, -1);
  };
  const auto direct = half(movement), mirror = half(mirrored(movement));
  return {0.5 * (direct[0] + code_in_mirror(mirror[0])), 0.5 * (direct[1] + mirror[1]) + kFirstDeviation};
}

InbetweenOutput InbetweenNetImpl::forward(const InbetweenInput& input, const torch::Tensor& code,
                                          const torch::Tensor& told) {
  const int64_t batch = input.root.size(0), frames = input.root.size(1);
  torch::Tensor added;
  if (code.defined())
    added = movement_told(torch::cat({code, torch::ones_like(told)}, -1) * told).unsqueeze(1);
  const auto out = WindowTransformerImpl::forward(input, added);
  const auto nearest = input.distance.amin(-1);  // [B, T, 23]
  // 0 where it is known, and the larger the farther that is: so much is the curve off.
  const auto free = kCorrection * (1 - (-(nearest / 2).square()).exp()) * ((nearest + 2) / 32).clamp_max(1);
  const auto turns = out.slice(-1, 0, kTurns).view({batch, frames, kJointCount, 6}) *
                     free.slice(2, 0, kJointCount).unsqueeze(-1);
  const auto none = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, out.options());
  const auto leg = leg_lengths(input.rest).view({batch, 1, 1});
  const auto way = out.slice(-1, kTurns, kTurns + 3) * free.slice(2, kRootPart) * leg;
  return {torch::matmul(input.rotations, rotations_from_6d(none + turns)), input.root + way,
          out.slice(-1, kTurns + 3, kTurns + 5), out.select(-1, kTurns + 5) - 3};
}

}  // namespace understudy::nn
