#include "retarget/nn/leaf_refiner.hpp"

#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/leaf_refiner.hpp"
#include "retarget/nn/scan_patches.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr int kRounds = 2;  // the second crop lies better than the first

constexpr float kHalfConfidence = 0.06f;  // metres
constexpr int kSurfacePoints = 8192;
constexpr uint64_t kSurfaceSeed = 20240319;

/// All points of a cloud, many of a surface.
Points dense_points(const Mesh& scan) {
  if (scan.is_cloud() || !scan.vertices.allFinite()) return scan.vertices;
  Rng rng(kSurfaceSeed);
  return sample_points(scan, kSurfacePoints, rng);
}

class NetworkLeafRefiner final : public LeafRefiner {
 public:
  explicit NetworkLeafRefiner(const std::string& path) {
    load_weights(path, "leaf", kLeafVersion, *net_);
    net_->eval();
  }

  void refine(const Mesh& scan, Extraction& seen) override {
    if (!seen.global) return;
    const torch::NoGradGuard no_grad;
    const Points points = dense_points(scan);
    // From the trunk outwards: a hand is looked at beside the forearm as it is known by then.
    for (int round = 0; round < kRounds; ++round)
      for (const LeafKind kind :
           {LeafKind::Arm, LeafKind::Hand, LeafKind::Head, LeafKind::Leg, LeafKind::Foot})
        refine_kind(points, kind, seen);
  }

 private:
  void refine_kind(const Points& points, LeafKind kind, Extraction& seen);
  static void correct(int slot, const Leaf& leaf, const float* said, const Extraction& before,
                      Extraction& seen);

  LeafRefinerNet net_;
};

void NetworkLeafRefiner::refine_kind(const Points& points, LeafKind kind, Extraction& seen) {
  std::vector<const Leaf*> leaves;
  std::vector<torch::Tensor> crops, contexts;
  for (const Leaf& leaf : kLeaves) {
    if (leaf.kind != kind) continue;
    const auto crop = cut_leaf(points, seen, leaf);
    if (!crop) continue;
    leaves.push_back(&leaf);
    crops.push_back(torch::from_blob(const_cast<float*>(crop->points.data()), {kLeafPoints, 3}).clone());
    contexts.push_back(torch::from_blob(const_cast<float*>(crop->context.data()), {kLeafContext}).clone());
  }
  if (leaves.empty()) return;
  const auto said = net_->of(kind)->forward(torch::stack(crops), torch::stack(contexts)).contiguous();
  const Extraction before = seen;
  for (size_t i = 0; i < leaves.size(); ++i)
    for (int k = 0; k < kLeafJoints; ++k)
      correct(k, *leaves[i],
              said.data_ptr<float>() + (i * kLeafJoints + static_cast<size_t>(k)) * kLeafNumbers, before,
              seen);
}

void NetworkLeafRefiner::correct(int slot, const Leaf& leaf, const float* said, const Extraction& before,
                                 Extraction& seen) {
  const int joint = leaf.corrects[static_cast<size_t>(slot)];
  if (joint < 0) return;
  const Mat3 local = rotation_from_6d(Eigen::Map<const Vec6>(said));
  (*seen.global)[static_cast<size_t>(joint)] = from_leaf(local, before, leaf);
  if (slot >= leaf.moves) return;
  const Vec3 way = way_from_leaf(Eigen::Map<const Vec3>(said + 6), before, leaf);
  seen.joints.row(joint) = before.joints.row(joint) + way.transpose();
  seen.confidence[joint] = confidence_for(std::exp(said[9]) * leg_length(before.joints));
}

}  // namespace

float confidence_for(float expected_error_m) {
  const float expected = expected_error_m / kHalfConfidence;
  return 1 / (1 + expected * expected);
}

std::unique_ptr<LeafRefiner> load_leaf_refiner(const std::string& path) {
  return std::make_unique<NetworkLeafRefiner>(path);
}

}  // namespace understudy::nn
