#include "retarget/training/skeleton_loss.hpp"

namespace understudy::training {

torch::Tensor mean_distance(const torch::Tensor& a, const torch::Tensor& b) {
  return ((a - b).square().sum(-1) + 1e-6).sqrt().mean();
}

torch::Tensor vote_loss(const torch::Tensor& votes, const torch::Tensor& centres, const torch::Tensor& joints,
                        double reach) {
  const auto to_joint = joints.unsqueeze(1) - centres.unsqueeze(2);                   // [B, M, 22, 3]
  const auto near = (to_joint.square().sum(-1) < reach * reach).to(torch::kFloat32);  // [B, M, 22]
  const auto error = ((votes - joints.unsqueeze(1)).square().sum(-1) + 1e-6).sqrt();  // [B, M, 22]
  return (near * error).sum() / near.sum().clamp_min(1.0);
}

torch::Tensor spread_loss(const torch::Tensor& joints, const torch::Tensor& truth,
                          const torch::Tensor& log_spread) {
  const auto error = (joints - truth).square().sum(-1).sqrt().detach();  // [B, 22]
  return (error * torch::exp(-log_spread) + log_spread).mean();
}

SkeletonLoss skeleton_loss(const nn::ExtractorOutput& out, const torch::Tensor& centres,
                           const SkeletonTruth& truth) {
  SkeletonLoss loss;
  if (!out.votes.defined()) {  // paper 1: L_skeleton = MSE
    loss.total = loss.joint = (out.joints - truth.joints).square().mean();
    loss.vote = loss.part = loss.rotation = loss.spread = torch::zeros({});
    return loss;
  }
  loss.joint = mean_distance(out.joints, truth.joints) + mean_distance(out.voted, truth.joints);
  loss.vote = vote_loss(out.votes, centres, truth.joints, /*reach=*/0.8);
  loss.part = torch::nn::functional::cross_entropy(out.parts.flatten(0, 1), truth.parts.flatten());
  loss.rotation = (out.rotations - truth.rotations).abs().mean();
  loss.spread = spread_loss(out.joints, truth.joints, out.log_spread);
  loss.total = loss.joint + loss.vote + 0.05 * loss.part + 0.3 * loss.rotation + 0.01 * loss.spread;
  return loss;
}

}  // namespace understudy::training
