#include "retarget/training/motion_step.hpp"

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/training/losses/motion_losses.hpp"

namespace understudy::training {

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
