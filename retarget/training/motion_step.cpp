#include "retarget/training/motion_step.hpp"

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/training/losses/motion_losses.hpp"

namespace understudy::training {
namespace {

constexpr int64_t kShortestInput = 15;  // frames that the convolutions need

torch::nn::Conv1d halving(int64_t inputs, int64_t outputs) {
  return torch::nn::Conv1d(torch::nn::Conv1dOptions(inputs, outputs, 4).stride(2));
}

}  // namespace

MotionDiscriminatorImpl::MotionDiscriminatorImpl(int64_t width) {
  constexpr int64_t kInputs = 3 * 3 * kJointCount;  // places, velocities, T-pose
  first = register_module("first", halving(kInputs, width));
  second = register_module("second", halving(width, width));
  third = register_module("third", torch::nn::Conv1d(torch::nn::Conv1dOptions(width, width, 2)));
  score = register_module("score", torch::nn::Linear(width, 1));
}

torch::Tensor MotionDiscriminatorImpl::forward(const torch::Tensor& joints, const torch::Tensor& rest,
                                               const torch::Tensor& dt) {
  const int64_t frames = joints.size(1);
  const auto heading = nn::headings(joints);  // [B, T, 3, 3]
  const auto around = joints - joints.slice(2, 0, 1);
  const auto place = torch::matmul(around, heading).flatten(2);  // [B, T, 66]
  const auto step = (around.slice(1, 1) - around.slice(1, 0, frames - 1)) /
                    (30 * dt.slice(1, 1)).unsqueeze(-1).unsqueeze(-1);
  const auto velocity = 10 * torch::matmul(step, heading.slice(1, 1)).flatten(2);  // [B, T-1, 66]
  const auto body = rest.flatten(1).unsqueeze(1).expand({-1, frames - 1, -1});
  auto x = torch::cat({place.slice(1, 1), velocity, body}, -1).transpose(1, 2);  // [B, 198, T-1]
  if (const int64_t missing = kShortestInput - x.size(2); missing > 0)
    x = torch::cat({x, x.slice(2, -1).expand({-1, -1, missing})}, 2);  // the last frame stays
  const auto relu = [](const torch::Tensor& t) { return torch::leaky_relu(t, 0.2); };
  const auto y = relu(third(relu(second(relu(first(x))))));  // [B, width, T/4]
  return score(y.mean(-1)).squeeze(-1);
}

MotionStep motion_step(nn::MotionGru& net, MotionDiscriminator& discriminator, const MotionBatch& batch,
                       const MotionLossWeights& weights) {
  const int64_t crossed = batch.crossed;
  const auto dt = batch.dt.slice(0, 0, crossed);
  nn::MotionState there, back;
  const auto local_b = net->forward({batch.joints, batch.leg, batch.dt, batch.seen_b}, there);  // A to B
  const auto made = nn::forward_kinematics(batch.rest_b, local_b).joints;
  const auto made_b = made.slice(0, 0, crossed);  // another body: no truth is known
  auto rotations = local_b.slice(0, crossed);     // B is A: these already came back
  auto joints = made.slice(0, crossed);
  if (crossed > 0) {
    const auto leg_b =
        nn::leg_lengths(batch.rest_b.slice(0, 0, crossed)).unsqueeze(1).expand({crossed, made.size(1)});
    const auto rest_a = batch.rest_a.slice(0, 0, crossed);
    const auto local_a = net->forward({made_b, leg_b, dt, rest_a}, back);  // and back to A
    rotations = torch::cat({local_a, rotations});
    joints = torch::cat({nn::forward_kinematics(rest_a, local_a).joints, joints});
  }

  LossSum loss;
  loss.add("cycle", cycle_loss(joints, batch.clean));
  loss.add("rotation", rotation_loss(rotations, batch.rotations), weights.rotation);
  loss.add("smoothness", smoothness_loss(joints, batch.clean, batch.dt), weights.smoothness);
  if (crossed > 0) {
    const auto scores = discriminator->forward(made_b, batch.rest_b.slice(0, 0, crossed), dt);
    loss.add("adversarial", adversarial_loss(scores), weights.adversarial);
  }
  return {loss, made_b.detach()};
}

}  // namespace understudy::training
