#include "retarget/training/deformation_step.hpp"

#include <algorithm>

#include "retarget/geometry/mesh.hpp"
#include "retarget/networks/network_deformer.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "retarget/training/losses/deformation_losses.hpp"

namespace understudy::training {
namespace {

using nn::tensor_of;
using torch::Tensor;

constexpr double kMillimetres = 1000;
constexpr int kEvaluatedPoses = 16;
constexpr int kEdges = 6;  // a vertex: design of medl_mm

Tensor add_offsets(const Tensor& points, const Tensor& offsets) {
  return points.unsqueeze(-1) + offsets;
}

}  // namespace

LossSum deformation_loss(nn::DeformationNet& net, const DeformationBatch& batch) {
  Tensor truth, true_offsets;
  {
    const torch::NoGradGuard no_grad;
    true_offsets = nn::pose_offsets(batch.basis, batch.features);
    truth = nn::blend_skin(batch.weights, add_offsets(batch.points, true_offsets), batch.transforms);
  }
  const Tensor code = net->body_code(batch.seen_joints, batch.surface);
  const nn::SurfaceFunctions out = net->forward(batch.points, batch.seen_joints, code);
  const Tensor offsets = nn::pose_offsets(out.basis, batch.features);
  const Tensor posed =
      nn::blend_skin(out.log_weights.exp(), add_offsets(batch.points, offsets), batch.transforms);

  LossSum loss;
  loss.add("geometry_mm", kMillimetres * geometry_loss(posed, truth));
  loss.add("edge_mm", kMillimetres * edge_loss(posed, truth));
  loss.add("weight_kl", weight_loss(out.log_weights, batch.weights), 5);
  loss.add("offset_mm", kMillimetres * offset_loss(offsets, true_offsets));
  loss.add("canonical_mm", kMillimetres * canonical_loss(out.canonical, batch.canonical, batch.has_canonical),
           0.1);
  return loss;
}

struct DeformationEvaluator::Target {
  Tensor vertices, joints, noisy_joints, surface;  // [V, 3], [22, 3], [22, 3], [M, 3]
  Tensor weights, basis;                           // truth
  Tensor features, transforms;                     // [1, P, 189], [1, P, 22, 12]
  Tensor from, to;                                 // edges
  bool clothed = false;
};

DeformationEvaluator::DeformationEvaluator(const TrainingData& data) {
  Rng rng(7);
  const int people = data.betas.size();
  for (int i = 0; i < std::min(4, people); ++i) add(data, data.body.shaped(data.betas[i * people / 4]), rng);
  for (size_t i = 0; i < std::min<size_t>(3, data.dressed.size()); ++i) add(data, data.dressed[i], rng);
}

void DeformationEvaluator::add(const TrainingData& data, const ShapedBody& body, Rng& rng) {
  auto target = std::make_shared<Target>();
  target->clothed = !body.pose_dirs;
  target->vertices = tensor_of(body.vertices);
  target->joints = tensor_of(body.joints);
  Joints noisy = body.joints;
  for (Eigen::Index i = 0; i < noisy.size(); ++i) noisy.data()[i] += 0.01f * rng.normal();
  target->noisy_joints = tensor_of(noisy);
  target->surface =
      tensor_of(nn::spread_points(body.vertices, static_cast<int>(nn::DeformationOptions().context_points)));
  target->weights = tensor_of(body.weights);
  target->basis = body.pose_dirs ? tensor_of(*body.pose_dirs).view({body.vertices.rows(), -1})
                                 : torch::zeros({body.vertices.rows(), 3 * nn::kPoseFeatureCount});
  target->features = torch::empty({1, kEvaluatedPoses, nn::kPoseFeatureCount});
  target->transforms = torch::empty({1, kEvaluatedPoses, kJointCount, 12});
  for (int k = 0; k < kEvaluatedPoses; ++k) {
    Pose pose;
    pose.local = random_pose(data, rng).local;
    target->features[0][k].copy_(tensor_of(pose_features(pose.local)).flatten());
    target->transforms[0][k].copy_(
        tensor_of(joint_transforms(body.joints, forward_kinematics(body.joints, pose))));
  }
  // Neighbours in the T-pose stand for those of every frame, from every fourth vertex: quick, and nearly the
  // same figure.
  const Points queries = body.vertices(Eigen::seq(0, Eigen::last, 4), Eigen::all);
  const auto near = nearest_neighbours(body.vertices, queries, kEdges + 1);
  std::vector<int64_t> from, to;
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    for (int k = 1; k <= kEdges; ++k) from.push_back(4 * i), to.push_back(near(i, k));
  target->from = torch::tensor(from, torch::kLong);
  target->to = torch::tensor(to, torch::kLong);
  targets_.push_back(target);
}

Figures DeformationEvaluator::evaluate(nn::DeformationNet& net) const {
  const torch::NoGradGuard no_grad;
  RunningMean naked, clothed;
  for (const auto& t : targets_) {
    const auto pose = [&t](const Tensor& weights, const Tensor& basis) {
      const Tensor offsets = nn::pose_offsets(basis.unsqueeze(0), t->features);
      return nn::blend_skin(weights.unsqueeze(0), add_offsets(t->vertices.unsqueeze(0), offsets),
                            t->transforms)
          .squeeze(0);
    };
    const auto edges = [&t](const Tensor& p) {
      return (p.index_select(0, t->from) - p.index_select(0, t->to)).norm(2, -1);
    };
    const Tensor truth = pose(t->weights, t->basis);
    const auto posed = [&](const Tensor& joints) {
      const auto bound = nn::bind_surface(net, t->vertices, joints, t->surface);
      return pose(bound.weights, bound.basis);
    };
    const auto error_mm = [&truth](const Tensor& p) {
      return kMillimetres * (p - truth).norm(2, -1).mean().item<double>();
    };
    const Tensor p = posed(t->joints);
    const double mpvd = error_mm(p);
    const double medl = kMillimetres * (edges(p) - edges(truth)).abs().mean().item<double>();
    if (t->clothed)
      clothed.add({{"clothed_mpvd_mm", mpvd}, {"clothed_medl_mm", medl}});
    else
      naked.add({{"dev_mpvd_mm", mpvd},
                 {"dev_medl_mm", medl},
                 {"dev_noisy_mpvd_mm", error_mm(posed(t->noisy_joints))}});
  }
  Figures figures = naked.mean();
  for (const Figure& figure : clothed.mean()) figures.push_back(figure);
  return figures;
}

}  // namespace understudy::training
