#include "retarget/training/motion_discriminator.hpp"

#include "retarget/nn/modules/motion_gru.hpp"

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

}  // namespace understudy::training
