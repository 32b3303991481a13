#include "retarget/training/inbetween_step.hpp"

#include "retarget/training/losses/inbetween_losses.hpp"

namespace understudy::training {
namespace {

constexpr double kSlow = 0.2 / kClipRate;  // metres a frame of a foot that stands

/// Of each frame, [B, T]: 0 where all is known, else more the shorter the window's longest gap is: so much is
/// a curve off there.
torch::Tensor frame_weights(const torch::Tensor& distance) {
  const auto apart = distance.amin(-1).amax(-1);  // [B, T] frames to the nearest known one
  const auto longest = 2 * apart.amax(-1, true);  // [B, 1]
  return (apart > 0).to(distance.dtype()) / (0.005 + 0.003 * longest);
}

/// A frame's weight for what is between it and its neighbours.
torch::Tensor between(const torch::Tensor& weight, int64_t n) {
  auto least = weight.slice(1, n);
  for (int64_t i = 0; i < n; ++i) least = torch::max(least, weight.slice(1, i, weight.size(1) - n + i));
  return least;
}

}  // namespace

LossSum inbetween_loss(const nn::InbetweenOutput& made, const InbetweenBatch& batch) {
  const auto& rest = batch.input.rest;
  const auto posed = nn::forward_kinematics(rest, made.rotations),
             truth = nn::forward_kinematics(rest, batch.rotations);
  const auto joints = posed.joints + made.root.unsqueeze(2),
             true_joints = truth.joints + batch.root.unsqueeze(2);
  const auto weight = frame_weights(batch.input.distance);
  const auto error = lengths(joints - true_joints);  // [B, T, 22]
  LossSum loss;
  loss.add("place", (weight * error.mean(-1)).mean());
  loss.add("around", (weight * lengths(posed.joints - truth.joints).mean(-1)).mean(), 0.5);
  loss.add("turn",
           (weight * (posed.global - truth.global).square().sum({-1, -2}).add(1e-6).sqrt().mean(-1)).mean(),
           0.1);
  loss.add("speed", (between(weight, 1) * difference_error(joints, true_joints, 1).mean(-1)).mean(), 3);
  loss.add("acceleration", (between(weight, 2) * difference_error(joints, true_joints, 2).mean(-1)).mean(),
           2);
  const auto feet =
      torch::tensor({int64_t(LeftAnkle), int64_t(LeftFoot), int64_t(RightAnkle), int64_t(RightFoot)});
  const auto made_feet = joints.index_select(2, feet), true_feet = true_joints.index_select(2, feet);
  loss.add("slide", (between(weight, 1) * sliding(made_feet, true_feet, kSlow).mean(-1)).mean(), 3);
  const auto toes = lengths(true_feet.diff(1, 1)).index_select(2, torch::tensor({int64_t(1), int64_t(3)}));
  const auto stands = (toes < kSlow).to(error.dtype());
  const auto unknown = (weight > 0).to(error.dtype());
  loss.add("standing",
           weighed_mean(torch::binary_cross_entropy_with_logits(made.standing.slice(1, 1), stands, {}, {},
                                                                at::Reduction::None),
                        unknown.slice(1, 1)),
           0.2);
  loss.add("doubt", weighed_mean((made.doubt - error.detach().mean(-1).add(1e-3).log()).abs(), unknown), 0.1);
  return loss;
}

}  // namespace understudy::training
