#include "retarget/training/losses/pose_code_losses.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "retarget/keypoints/proportions.hpp"

namespace understudy::training {
namespace {

constexpr double kLinkSigma = 0.05;

/// Of both ends of each pair, along each direction: the second's place from the first, [B, P, D].
torch::Tensor links(const torch::Tensor& poses, const torch::Tensor& pairs, const torch::Tensor& directions) {
  const auto ends = poses.index_select(1, pairs.flatten()).view({-1, pairs.size(0), 2, 2});
  return torch::matmul(ends.select(2, 0) - ends.select(2, 1), directions.t());
}

/// 1 where both ends count, [B, P, 1].
torch::Tensor linked(const torch::Tensor& mask, const torch::Tensor& pairs) {
  return mask.index_select(1, pairs.flatten()).view({-1, pairs.size(0), 2}).prod(2).unsqueeze(2);
}

/// Mean over the pairs that count, sum over directions.
torch::Tensor over_links(const torch::Tensor& losses, const torch::Tensor& counts) {
  return (losses * counts).sum() / counts.sum().clamp_min(1);
}

}  // namespace

torch::Tensor link_pairs(LinkPairs which) {
  std::vector<int64_t> pairs;
  const auto add = [&](int a, int b) { pairs.push_back(a), pairs.push_back(b); };
  if (which == LinkPairs::All) {
    for (int i = 0; i < kPaperPoints; ++i)
      for (int j = 0; j < i; ++j) add(i, j);
  } else {
    for (const FlatBone& bone : kFlatBones) add(bone.from, bone.to);
  }
  const std::array<int, 5> ends = {body25::Nose, body25::LeftWrist, body25::RightWrist, body25::LeftAnkle,
                                   body25::RightAnkle};
  if (which == LinkPairs::BonesAndEnds)
    for (size_t i = 0; i < ends.size(); ++i)
      for (size_t j = 0; j < i; ++j) add(ends[i], ends[j]);
  return torch::tensor(pairs).view({-1, 2});
}

torch::Tensor link_directions(int count, double first_deg) {
  std::vector<float> directions;
  for (int k = 0; k < count; ++k) {
    const double angle = first_deg * M_PI / 180 + M_PI * k / count;
    directions.push_back(static_cast<float>(std::cos(angle)));
    directions.push_back(static_cast<float>(std::sin(angle)));
  }
  return torch::tensor(directions).view({-1, 2});
}

torch::Tensor virtual_link_loss(const torch::Tensor& made, const torch::Tensor& source,
                                const torch::Tensor& mask, const torch::Tensor& pairs,
                                const torch::Tensor& directions) {
  const auto is = links(made, pairs, directions), was = links(source, pairs, directions);
  const auto ordered = torch::relu(kLinkSigma - torch::sign(was) * is);
  return over_links(torch::where(was.abs() < kLinkSigma, is.square(), ordered), linked(mask, pairs));
}

torch::Tensor link_ranking_loss(const torch::Tensor& made, const torch::Tensor& source,
                                const torch::Tensor& mask, const torch::Tensor& pairs,
                                const torch::Tensor& directions) {
  const auto is = links(made, pairs, directions), was = links(source, pairs, directions);
  const auto ordered = torch::softplus(-torch::sign(was) * is);
  return over_links(torch::where(was.abs() < kLinkSigma, is.square(), ordered), linked(mask, pairs));
}

torch::Tensor bone_angle_loss(const torch::Tensor& made, const torch::Tensor& source,
                              const torch::Tensor& mask) {
  const auto bones = link_pairs(LinkPairs::Bones).to(made.device());
  const auto axes = torch::eye(2).to(made.device());
  const auto is = links(made, bones, axes), was = links(source, bones, axes);  // [B, 14, 2]
  const auto cosine = (is * was).sum(2, true) /
                      ((is.square().sum(2, true) + 1e-8).sqrt() * (was.square().sum(2, true) + 1e-8).sqrt());
  return over_links(1 - cosine, linked(mask, bones));
}

torch::Tensor same_pose_loss(const torch::Tensor& made, const torch::Tensor& source,
                             const torch::Tensor& mask) {
  return ((made - source).abs() * mask.unsqueeze(2)).sum() / static_cast<double>(made.size(0));
}

torch::Tensor hinge_real(const torch::Tensor& scores) {
  return torch::relu(1 - scores).mean();
}

torch::Tensor hinge_made(const torch::Tensor& scores) {
  return torch::relu(1 + scores).mean();
}

}  // namespace understudy::training
