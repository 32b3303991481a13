#include "retarget/training/deformation_step.hpp"

#include <algorithm>

#include "retarget/geometry/mesh.hpp"
#include "retarget/nn/network_deformer.hpp"
#include "retarget/training/deformation_losses.hpp"

namespace understudy::training {
namespace {

using torch::Tensor;

constexpr double kMillimetres = 1000;
constexpr int kEvaluatedPoses = 16;
constexpr int kEdges = 6;  // a vertex: design of medl_mm

Tensor add_offsets(const Tensor& points, const Tensor& offsets) {
  return points.unsqueeze(-1) + offsets;
}

template <class Matrix>
Tensor tensor_of(const Matrix& m) {
  return torch::from_blob(const_cast<float*>(m.data()), {m.rows(), m.cols()}).clone();
}

}  // namespace

DeformationLoss deformation_loss(nn::DeformationNet& net, const DeformationBatch& batch) {
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

  const Tensor geometry = kMillimetres * geometry_loss(posed, truth);
  const Tensor edges = kMillimetres * edge_loss(posed, truth);
  const Tensor weight = weight_loss(out.log_weights, batch.weights);
  const Tensor offset = kMillimetres * offset_loss(offsets, true_offsets);
  const Tensor canonical = kMillimetres * canonical_loss(out.canonical, batch.canonical, batch.has_canonical);
  DeformationLoss loss;
  loss.total = geometry + edges + 5 * weight + offset + 0.1 * canonical;
  loss.geometry_mm = geometry.item<double>();
  loss.edge_mm = edges.item<double>();
  loss.weight_kl = weight.item<double>();
  loss.offset_mm = offset.item<double>();
  loss.canonical_mm = canonical.item<double>();
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
  const int people = static_cast<int>(data.betas.size());
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
    const Rotations pose = random_pose(data, rng).local;
    target->features[0][k].copy_(tensor_of(pose_features(pose)).flatten());
    target->transforms[0][k].copy_(tensor_of(joint_transforms(body.joints, pose)));
  }
  // Neighbours in the T-pose stand for those of every frame, from every fourth vertex: quick, and nearly the
  // same figure.
  Points queries((body.vertices.rows() + 3) / 4, 3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) queries.row(i) = body.vertices.row(4 * i);
  const auto near = nearest_neighbours(body.vertices, queries, kEdges + 1);
  std::vector<int64_t> from, to;
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    for (int k = 1; k <= kEdges; ++k) from.push_back(4 * i), to.push_back(near(i, k));
  target->from = torch::tensor(from, torch::kLong);
  target->to = torch::tensor(to, torch::kLong);
  targets_.push_back(target);
}

DeformationScore DeformationEvaluator::score(nn::DeformationNet& net) const {
  const torch::NoGradGuard no_grad;
  DeformationScore score;
  double naked = 0, clothed = 0;
  for (const auto& t : targets_) (t->clothed ? clothed : naked) += 1;
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
    const auto bound = nn::bind_surface(net, t->vertices, t->joints, t->surface);
    const Tensor posed = pose(bound.weights, bound.basis);
    const double mpvd = kMillimetres * (posed - truth).norm(2, -1).mean().item<double>();
    const double medl = kMillimetres * (edges(posed) - edges(truth)).abs().mean().item<double>();
    (t->clothed ? score.clothed_mpvd_mm : score.mpvd_mm) += mpvd / (t->clothed ? clothed : naked);
    (t->clothed ? score.clothed_medl_mm : score.medl_mm) += medl / (t->clothed ? clothed : naked);
    if (t->clothed) continue;
    const auto noisy = nn::bind_surface(net, t->vertices, t->noisy_joints, t->surface);
    score.noisy_mpvd_mm +=
        kMillimetres * (pose(noisy.weights, noisy.basis) - truth).norm(2, -1).mean().item<double>() / naked;
  }
  return score;
}

}  // namespace understudy::training
