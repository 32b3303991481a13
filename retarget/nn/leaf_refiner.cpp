#include "retarget/nn/leaf_refiner.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/nn/modules/leaf_refiner.hpp"
#include "retarget/nn/scan_patches.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pipeline/confidence.hpp"

namespace understudy::nn {
namespace {

constexpr int kRounds = 2;  // the second crop lies better than the first

// A crop tells more of a joint's error than the whole body does, the two together still more.
constexpr float kShareOfCrop = 0.7f;
// A joint that may be farther off than so is perhaps looked for in the wrong place, at the other leg say,
// where the crop tells nothing of it. Metres: from where that begins to where the crop is not believed at
// all.
constexpr float kNear = 0.05f, kAstray = 0.12f;
constexpr int kSurfacePoints = 8192;
constexpr uint64_t kSurfaceSeed = 20240319;

/// All points of a cloud, many of a surface.
Points dense_points(const Mesh& scan) {
  if (scan.is_cloud() || !scan.vertices.allFinite()) return scan.vertices;
  Rng rng(kSurfaceSeed);
  return sample_points(scan, kSurfacePoints, rng);
}

/// Of a joint that was seen with the confidence `whole`, then from near with `crop`.
float confidence_of_both(float crop, float whole);

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
    const auto whole = seen.confidence;  // from the whole body
    // From the trunk outwards: a hand is looked at beside the forearm as it is known by then.
    for (int round = 0; round < kRounds; ++round)
      for (const LeafKind kind :
           {LeafKind::Arm, LeafKind::Hand, LeafKind::Head, LeafKind::Leg, LeafKind::Foot})
        refine_kind(points, kind, seen);
    for (int j = 0; j < kJointCount; ++j)
      if (seen.confidence[j] != whole[j])
        seen.confidence[j] = confidence_of_both(seen.confidence[j], whole[j]);
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

float confidence_of_both(float crop, float whole) {
  constexpr float kLeast = 0.001f;  // metres
  const float near = std::max(kLeast, expected_error_for(crop)),
              far = std::max(kLeast, expected_error_for(whole));
  const float both = std::pow(near, kShareOfCrop) * std::pow(far, 1 - kShareOfCrop);
  const float astray = smooth_step(kNear, kAstray, far);
  return confidence_for(both + astray * (std::max(both, far) - both));
}

}  // namespace

std::unique_ptr<LeafRefiner> load_leaf_refiner(const std::string& path) {
  return std::make_unique<NetworkLeafRefiner>(path);
}

}  // namespace understudy::nn
