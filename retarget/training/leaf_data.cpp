#include "retarget/training/leaf_data.hpp"

#include <cmath>
#include <vector>

#include "retarget/math/random_direction.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr float kRadians = kPi / 180;

using Told = Eigen::Matrix<float, 9, 1>;

struct Crops {
  std::vector<nn::LeafCrop> crops;
  std::vector<std::array<Told, nn::kLeafJoints>> truth, before;
};

ScanMaker maker(const TrainingData& data, int points, uint64_t seed) {
  ScanMakerOptions options;
  options.points = points;
  options.limp = 0.4f;
  return ScanMaker(data, options, seed);
}

Told told(const Mat3& rotation, const Vec3& way, const Extraction& seen, const nn::Leaf& leaf) {
  Told result;
  result << rotation_to_6d(nn::into_leaf(rotation, seen, leaf)), nn::way_into_leaf(way, seen, leaf);
  return result;
}

torch::Tensor tensor_of(const std::vector<std::array<Told, nn::kLeafJoints>>& rows) {
  auto tensor = torch::empty({static_cast<int64_t>(rows.size()), nn::kLeafJoints, 9});
  float* out = tensor.data_ptr<float>();
  for (const auto& row : rows)
    for (const Told& one : row) out = std::copy(one.data(), one.data() + one.size(), out);
  return tensor;
}

LeafBatch batch_of(const Crops& made) {
  const auto B = static_cast<int64_t>(made.crops.size());
  LeafBatch batch{torch::empty({B, nn::kLeafPoints, 3}), torch::empty({B, nn::kLeafContext}),
                  tensor_of(made.truth), tensor_of(made.before)};
  for (int64_t b = 0; b < B; ++b) {
    const nn::LeafCrop& crop = made.crops[static_cast<size_t>(b)];
    std::copy(crop.points.data(), crop.points.data() + crop.points.size(),
              batch.points.data_ptr<float>() + b * crop.points.size());
    std::copy(crop.context.data(), crop.context.data() + nn::kLeafContext,
              batch.context.data_ptr<float>() + b * nn::kLeafContext);
  }
  return batch;
}

}  // namespace

LeafSampler::LeafSampler(const TrainingData& data, uint64_t seed)
    : makers_{maker(data, 2500, seed), maker(data, 5000, seed + 1), maker(data, 9000, seed + 2)},
      rng_(seed + 3) {}

Extraction LeafSampler::pretend(const PosedSkeleton& truth) {
  Extraction seen;
  const auto turned = [this](float degrees) {
    const Vec3 axis = random_direction(rng_);
    return rotation_from_axis_angle(degrees * kRadians * std::abs(rng_.normal()) * axis);
  };
  const float kind = rng_.uniform();
  const float spread = kind < 0.12f   ? rng_.uniform(0.025f, 0.05f)
                       : kind < 0.32f ? 0.025f
                                      : rng_.uniform(0.003f, 0.014f);
  seen.global.emplace();
  Joints error = Joints::Zero();
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    if (kParents[j] >= 0)
      error.row(row) = 0.5f * error.row(kParents[j]);  // limbs are misplaced as a whole, too
    for (int axis = 0; axis < 3; ++axis) error(row, axis) += spread * rng_.normal();
    seen.joints.row(row) = truth.joints.row(row) + error.row(row);
    const int p = kParents[j];
    const Eigen::Quaternionf own(truth.global[j]);
    // What the limb suggests of the leaf on it: no bend.
    const Eigen::Quaternionf parent(truth.global[static_cast<size_t>(p < 0 ? 0 : p)]);
    const float drawn = rng_.chance(0.6f) ? rng_.uniform() : 0.0f;
    (*seen.global)[j] = turned(10) * own.slerp(drawn, parent).toRotationMatrix();
  }
  return seen;
}

LeafBatches LeafSampler::next(int scans) {
  std::array<Crops, nn::kLeafKinds> made;
  for (int n = 0; n < scans; ++n) {
    const MadeScan scan = makers_[static_cast<size_t>(rng_.below(3))].next();
    const Extraction seen = pretend(scan.truth);
    for (const nn::Leaf& leaf : nn::kLeaves) {
      const auto crop = nn::cut_leaf(scan.points, seen, leaf);
      if (!crop) continue;
      Crops& to = made[static_cast<size_t>(leaf.kind)];
      std::array<Told, nn::kLeafJoints> truth, before;
      Told none = Told::Zero();
      none[0] = none[4] = 1;
      truth.fill(none);
      before = truth;
      for (size_t k = 0; k < nn::kLeafJoints; ++k) {
        if (leaf.corrects[k] < 0) continue;
        const auto j = static_cast<size_t>(leaf.corrects[k]);
        const Vec3 way =
            (scan.truth.joints.row(leaf.corrects[k]) - seen.joints.row(leaf.corrects[k])).transpose();
        truth[k] = told(scan.truth.global[j], way, seen, leaf);
        before[k] = told((*seen.global)[j], Vec3::Zero(), seen, leaf);
      }
      to.crops.push_back(*crop);
      to.truth.push_back(truth);
      to.before.push_back(before);
    }
  }
  LeafBatches batches;
  for (size_t kind = 0; kind < made.size(); ++kind) batches[kind] = batch_of(made[kind]);
  return batches;
}

}  // namespace understudy::training
