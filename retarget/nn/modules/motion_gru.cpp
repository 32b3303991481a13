#include "retarget/nn/modules/motion_gru.hpp"

#include <vector>

#include "retarget/nn/modules/forward_kinematics.hpp"

namespace understudy::nn {
namespace {

constexpr int64_t kMotionBones = kJointCount - 1;
constexpr int64_t kShape = 3 * kMotionBones + 3 * kMotionBones + kMotionBones;  // places, directions, lengths
constexpr int64_t kSourceFeatures = kShape + 3 * kMotionBones + 3;  // and velocities, turning, the interval
constexpr int64_t kRestWidth = 48;
constexpr double kRate = 30;  // velocities are per frame at 30 frames/s

torch::Tensor parents_of(const torch::Tensor& like) {
  std::vector<int64_t> parents(kParents.begin() + 1, kParents.end());
  return torch::tensor(parents, torch::TensorOptions().dtype(torch::kLong).device(like.device()));
}

/// Joints [..., 22, 3] around the pelvis, over a length: places, directions and lengths of bones, [...,
/// kShape].
torch::Tensor shape_features(const torch::Tensor& joints) {
  const auto child = joints.slice(-2, 1);                                 // [..., 21, 3]
  const auto bone = child - joints.index_select(-2, parents_of(joints));  // [..., 21, 3]
  const auto length = bone.square().sum(-1, true).add(1e-8).sqrt();       // [..., 21, 1]
  return torch::cat({child.flatten(-2), (bone / length).flatten(-2), length.squeeze(-1)}, -1);
}

torch::Tensor around_pelvis(const torch::Tensor& joints) {
  return joints - joints.slice(-2, 0, 1);
}

}  // namespace

torch::Tensor leg_lengths(const torch::Tensor& joints) {
  const auto bone = [&joints](int a, int b) {
    return (joints.select(1, a) - joints.select(1, b)).norm(2, -1);
  };
  return 0.5 * (bone(LeftHip, LeftKnee) + bone(LeftKnee, LeftAnkle) + bone(RightHip, RightKnee) +
                bone(RightKnee, RightAnkle));
}

torch::Tensor headings(const torch::Tensor& joints) {
  const auto at = [fixed = joints.detach()](int j) { return fixed.select(-2, j); };
  const auto side = at(LeftHip) - at(RightHip) + at(LeftShoulder) - at(RightShoulder);  // +x in T-pose
  const auto norm = (side.select(-1, 0).square() + side.select(-1, 2).square()).add(1e-10).sqrt();
  const auto c = side.select(-1, 0) / norm, s = -side.select(-1, 2) / norm;
  const auto zero = torch::zeros_like(c), one = torch::ones_like(c);
  return torch::stack({c, zero, s, zero, one, zero, -s, zero, c}, -1)
      .view({joints.size(0), joints.size(1), 3, 3});
}

MotionGruImpl::MotionGruImpl(const MotionGruOptions& options) : quaternions_(options.quaternions) {
  const int64_t h = options.hidden;
  const auto gru = [&](int64_t inputs) {
    return torch::nn::GRU(torch::nn::GRUOptions(inputs, h).num_layers(options.layers).batch_first(true));
  };
  embed_source = register_module("embed_source", torch::nn::Linear(kSourceFeatures, h));
  embed_rest = register_module("embed_rest", torch::nn::Linear(kShape, kRestWidth));
  encoder = register_module("encoder", gru(h));
  decoder = register_module("decoder", gru(2 * h + kRestWidth));
  head = register_module("head",
                         torch::nn::Sequential(torch::nn::Linear(3 * h + kRestWidth, 256), torch::nn::ELU(),
                                               torch::nn::Linear(256, 256), torch::nn::ELU(),
                                               torch::nn::Linear(256, (quaternions_ ? 4 : 6) * kJointCount)));
}

torch::Tensor MotionGruImpl::source_features(const MotionInput& input, const MotionState& state,
                                             const torch::Tensor& heading) const {
  const int64_t frames = input.joints.size(1);
  const auto first = state.joints.defined() ? state.joints : input.joints.slice(1, 0, 1);
  const auto before = torch::cat({first, input.joints.slice(1, 0, frames - 1)}, 1);  // [B, T, 22, 3]
  const auto leg = input.leg.view({-1, frames, 1, 1});
  const auto interval = (input.dt * kRate).unsqueeze(-1);  // [B, T, 1]

  const auto now = torch::matmul(around_pelvis(input.joints), heading) / leg;  // rows times H = H^T joints
  const auto then = torch::matmul(around_pelvis(before), heading) / leg;
  const auto velocity = (now - then).slice(2, 1).flatten(2) / interval;
  const auto turn = torch::matmul(headings(before).transpose(-1, -2), heading);  // since the frame before
  const auto turned = torch::stack({turn.select(-2, 0).select(-1, 0), turn.select(-2, 0).select(-1, 2)}, -1);
  return torch::cat({shape_features(now), velocity, turned, interval.clamp(0.5, 1.5)}, -1);
}

/// Zero output is the T-pose.
torch::Tensor MotionGruImpl::rotations(const torch::Tensor& output) const {
  if (quaternions_)
    return rotations_from_quaternions(output + torch::tensor({1.f, 0.f, 0.f, 0.f}, output.options()));
  return rotations_from_6d(output + torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}, output.options()));
}

torch::Tensor MotionGruImpl::forward(const MotionInput& input, MotionState& state) {
  const int64_t batch = input.joints.size(0), frames = input.joints.size(1);
  const auto heading = headings(input.joints);                                      // [B, T, 3, 3]
  const auto x = torch::elu(embed_source(source_features(input, state, heading)));  // [B, T, H]
  torch::Tensor h, d;
  std::tie(h, state.encoder) = encoder(x, state.encoder);  // [B, T, H]

  const auto rest = around_pelvis(input.rest) / leg_lengths(input.rest).view({batch, 1, 1});
  const auto b =
      torch::elu(embed_rest(shape_features(rest))).unsqueeze(1).expand({batch, frames, kRestWidth});

  const auto locomotion = torch::cat({h, x}, -1);                                        // [B, T, 2H]
  std::tie(d, state.decoder) = decoder(torch::cat({locomotion, b}, -1), state.decoder);  // [B, T, H]
  const auto bend = head->forward(torch::cat({d, locomotion, b}, -1)).view({batch, frames, kJointCount, -1});
  const auto local = rotations(bend);  // [B, T, 22, 3, 3]
  state.joints = input.joints.slice(1, frames - 1).detach();
  const auto root = torch::matmul(heading, local.select(2, 0)).unsqueeze(2);
  return torch::cat({root, local.slice(2, 1)}, 2);
}

}  // namespace understudy::nn
