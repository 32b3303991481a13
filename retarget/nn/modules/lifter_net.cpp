#include "retarget/nn/modules/lifter_net.hpp"

#include <vector>

#include "retarget/pose2d/lift_input.hpp"

namespace understudy::nn {
namespace {

/// [B, T, 22, 2]: where the joints' points are seen, zero where they or the hips are not.
torch::Tensor seen_places(const torch::Tensor& frames) {
  std::vector<int64_t> points;
  std::vector<float> told;
  for (const int point : kPointOfJoint) {
    points.push_back(std::max(point, 0));
    told.push_back(point < 0 ? 0.0f : 1 / kLiftPlaceScale);
  }
  const auto device = frames.device();
  const auto all = frames.slice(-1, 0, kLiftPointInputs * kBodyPoints)
                       .unflatten(-1, {kBodyPoints, kLiftPointInputs})
                       .slice(-1, 0, 2);  // [B, T, 25, 2]
  const auto hips = frames.slice(-1, kLiftInputs - 1).unsqueeze(-1);
  return all.index_select(-2, torch::tensor(points).to(device)) *
         torch::tensor(told).to(device).view({-1, 1}) * hips;
}

}  // namespace

LifterNetImpl::LifterNetImpl()
    : embed(register_module("embed", torch::nn::Linear(kLiftInputs, kLifterEmbedded))),
      head(register_module("head", torch::nn::Linear(kLifterEmbedded + kLifterHidden, kLifterHead))),
      last(register_module("last", torch::nn::Linear(kLifterHead, kLifterOutputs))),
      memory(register_module(
          "memory",
          torch::nn::GRU(torch::nn::GRUOptions(kLifterEmbedded, kLifterHidden).batch_first(true)))) {}

LifterNetImpl::Lifted LifterNetImpl::forward(const torch::Tensor& frames, torch::Tensor& state) {
  const auto x = torch::relu(embed(frames));  // [B, T, embedded]
  torch::Tensor h;
  std::tie(h, state) = memory(x, state);                           // [B, T, hidden]
  const auto y = last(torch::relu(head(torch::cat({x, h}, -1))));  // [B, T, outputs]
  const auto places = y.slice(-1, 0, kLifterDoubtsAt).unflatten(-1, {kJointCount, 3});
  const auto seen = torch::constant_pad_nd(seen_places(frames), {0, 1});  // of depth nothing is seen
  return {places + seen, y.slice(-1, kLifterDoubtsAt, kLifterTurnsAt).clamp(kLeastLogOff, kMostLogOff),
          y.slice(-1, kLifterTurnsAt, kLifterPitchAt).unflatten(-1, {kJointCount, 6}),
          y.select(-1, kLifterPitchAt)};
}

}  // namespace understudy::nn
