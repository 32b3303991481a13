#include "retarget/nn/modules/hybrid_gru.hpp"

#include <algorithm>

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/modules/joint_tensors.hpp"
#include "retarget/nn/modules/motion_gru.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t J = kJointCount;
// Places and velocities but the pelvis', rotations solved, how the seen ones differ, how the solve turned,
// confidences; whether rotations were seen, the interval, the heading's turn.
constexpr int64_t kFeatures = 2 * 3 * (J - 1) + 6 * J + 6 * J + 3 * J + J + 1 + 1 + 2;
constexpr double kRate = 30;  // velocities are told as at 30 frames/s
// Below one half, the first two columns of a correction can never become parallel.
constexpr double kMostChange = 0.49;

torch::Tensor upright(const torch::Tensor& like) {
  return torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, like.options());
}

/// x [B, T, ...] one frame earlier; the first frame's is `before` [B, 1, ...], or itself.
torch::Tensor earlier(const torch::Tensor& x, const torch::Tensor& before) {
  const auto first = before.defined() ? before : x.slice(1, 0, 1);
  return torch::cat({first, x.slice(1, 0, x.size(1) - 1)}, 1);
}

/// Axis times sine of the angle of rotations [..., 3, 3] -> [..., 3].
torch::Tensor turn_vector(const torch::Tensor& R) {
  const auto skew = 0.5 * (R - R.transpose(-1, -2));
  return torch::stack(
      {skew.select(-2, 2).select(-1, 1), skew.select(-2, 0).select(-1, 2), skew.select(-2, 1).select(-1, 0)},
      -1);
}

torch::Tensor features(const HybridInput& in, const HybridState& state) {
  const auto T = in.joints.size(1);
  const auto before = earlier(in.joints, state.joints), solved_before = earlier(in.solved, state.solved);
  const auto heading = headings(in.joints);             // [B, T, 3, 3]
  const auto interval = (in.dt * kRate).unsqueeze(-1);  // [B, T, 1]
  const auto leg = in.leg.view({-1, T, 1, 1});
  const auto placed = [&](const torch::Tensor& joints) {
    return torch::matmul(joints - joints.slice(2, 0, 1), heading).slice(2, 1) / leg;  // [B, T, 21, 3]
  };
  const auto now = placed(in.joints);
  const auto velocity = (now - placed(before)).flatten(2) / interval;
  const auto facing = torch::matmul(heading.transpose(-1, -2).unsqueeze(2), in.solved);  // [B, T, 22, 3, 3]
  const auto differs = torch::matmul(in.solved.transpose(-1, -2), in.seen);
  const auto turned = torch::matmul(solved_before.transpose(-1, -2), in.solved);
  const auto spin = turn_vector(turned).flatten(2) / interval;
  const auto turn = torch::matmul(headings(before).transpose(-1, -2), heading).select(-2, 0);  // [B, T, 3]
  const auto heading_turn = torch::stack({turn.select(-1, 0), turn.select(-1, 2)}, -1);
  return torch::cat({now.flatten(2), velocity, rotations_to_6d(facing).flatten(2),
                     (rotations_to_6d(differs) - upright(now)).flatten(2), spin, in.confidence,
                     in.has_seen.unsqueeze(-1), interval.clamp(0.5, 2.0), heading_turn},
                    -1);
}

}  // namespace

HybridInput stack_frames(const std::vector<std::vector<HybridFrame>>& sequences) {
  const auto B = static_cast<int64_t>(sequences.size()), T = static_cast<int64_t>(sequences.at(0).size());
  HybridInput in{torch::empty({B, T, J, 3}), torch::empty({B, T}),          torch::empty({B, T}),
                 torch::empty({B, T, J}),    torch::empty({B, T, J, 3, 3}), torch::empty({B, T, J, 3, 3}),
                 torch::empty({B, T})};
  for (int64_t i = 0; i < B * T; ++i) {
    const HybridFrame& frame = sequences[static_cast<size_t>(i / T)].at(static_cast<size_t>(i % T));
    std::copy_n(frame.joints.data(), 3 * J, in.joints.data_ptr<float>() + i * 3 * J);
    std::copy_n(frame.confidence.data(), J, in.confidence.data_ptr<float>() + i * J);
    for (int j = 0; j < kJointCount; ++j)
      for (int k = 0; k < 9; ++k) {
        in.solved.data_ptr<float>()[(i * J + j) * 9 + k] = frame.solved[j](k / 3, k % 3);
        in.seen.data_ptr<float>()[(i * J + j) * 9 + k] = frame.seen[j](k / 3, k % 3);
      }
    in.leg.data_ptr<float>()[i] = frame.leg;
    in.dt.data_ptr<float>()[i] = frame.dt;
    in.has_seen.data_ptr<float>()[i] = frame.has_seen ? 1.0f : 0.0f;
  }
  return in;
}

HybridInput to_device(const HybridInput& in, const torch::Device& device) {
  return {in.joints.to(device), in.leg.to(device),  in.dt.to(device),      in.confidence.to(device),
          in.solved.to(device), in.seen.to(device), in.has_seen.to(device)};
}

HybridGruImpl::HybridGruImpl(const HybridGruOptions& options) {
  const int64_t H = options.hidden;
  embed = register_module("embed", torch::nn::Linear(kFeatures, H));
  gru = register_module(
      "gru", torch::nn::GRU(torch::nn::GRUOptions(H, H).num_layers(options.layers).batch_first(true)));
  head = register_module("head", torch::nn::Sequential(torch::nn::Linear(2 * H, H), torch::nn::ELU()));
  last = register_module("last", torch::nn::Linear(H, 6 * J));
  const torch::NoGradGuard no_grad;
  last->weight.zero_();
  last->bias.zero_();
}

torch::Tensor HybridGruImpl::forward(const HybridInput& input, HybridState& state) {
  const auto B = input.joints.size(0), T = input.joints.size(1);
  const auto x = torch::elu(embed(features(input, state)));  // [B, T, H]
  torch::Tensor h;
  std::tie(h, state.hidden) = gru(x, state.hidden);
  const auto said = last(head->forward(torch::cat({h, x}, -1))).view({B, T, J, 6});
  state.joints = input.joints.slice(1, T - 1).detach();
  state.solved = input.solved.slice(1, T - 1).detach();
  return torch::matmul(input.solved, rotations_from_6d(upright(said) + kMostChange * torch::tanh(said)));
}

torch::Tensor local_rotations(const torch::Tensor& global) {
  const std::vector<int64_t> parents(kParents.begin() + 1, kParents.end());
  const auto of = torch::tensor(parents, torch::TensorOptions().dtype(torch::kLong).device(global.device()));
  const auto child = torch::matmul(global.index_select(2, of).transpose(-1, -2), global.slice(2, 1));
  return torch::cat({global.slice(2, 0, 1), child}, 2);
}

}  // namespace understudy::nn
