#include "retarget/training/part_data.hpp"

#include <cmath>
#include <vector>

#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr float kRadians = kPi / 180;

/// Making a scan costs more than cutting and learning: each is looked at from so many wrong extractions.
constexpr int kLooks = 2;

using Label = PartSampler::Label;
using Crops = PartSampler::Crops;

ScanMaker maker(const TrainingData& data, int points, uint64_t seed) {
  ScanMakerOptions options;
  options.points = points;
  options.limp = 0.4f;
  return ScanMaker(data, options, seed);
}

Label label_of(const Mat3& rotation, const Vec3& displacement, const Extraction& seen, const nn::Part& part) {
  Label result;
  result << rotation_to_6d(nn::into_part(rotation, seen, part)),
      nn::vector_into_part(displacement, seen, part);
  return result;
}

torch::Tensor tensor_of(const std::vector<std::array<Label, nn::kPartJoints>>& rows) {
  auto tensor = torch::empty({static_cast<int64_t>(rows.size()), nn::kPartJoints, 9});
  float* out = tensor.data_ptr<float>();
  for (const auto& row : rows)
    for (const Label& one : row) out = std::copy(one.data(), one.data() + one.size(), out);
  return tensor;
}

PartBatch batch_of(const Crops& made, nn::PartKind kind) {
  const auto B = static_cast<int64_t>(made.crops.size());
  PartBatch batch{torch::empty({B, nn::rows_of(kind), 3}), torch::empty({B, nn::kPartContext}),
                  tensor_of(made.truth), tensor_of(made.before)};
  for (int64_t b = 0; b < B; ++b) {
    const nn::PartCrop& crop = made.crops[b];
    std::copy(crop.points.data(), crop.points.data() + crop.points.size(),
              batch.points.data_ptr<float>() + b * crop.points.size());
    std::copy(crop.context.data(), crop.context.data() + nn::kPartContext,
              batch.context.data_ptr<float>() + b * nn::kPartContext);
  }
  return batch;
}

}  // namespace

PartSampler::PartSampler(const TrainingData& data, const PartKinds& kinds, uint64_t seed)
    : kinds_(kinds),
      makers_{maker(data, 2500, seed), maker(data, 5000, seed + 1), maker(data, 9000, seed + 2)},
      rng_(seed + 3) {}

Extraction PartSampler::pretend(const PosedSkeleton& truth) {
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
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    if (p >= 0) error.row(j) = 0.5f * error.row(p);  // limbs are misplaced as a whole, too
    for (int axis = 0; axis < 3; ++axis) error(j, axis) += spread * rng_.normal();
    seen.joints.row(j) = truth.joints.row(j) + error.row(j);
    const Eigen::Quaternionf own(truth.global[j]);
    // Pulled to the parent: as if the part did not bend.
    const Eigen::Quaternionf parent(truth.global[p < 0 ? 0 : p]);
    const float drawn = rng_.chance(0.6f) ? rng_.uniform() : 0.0f;
    (*seen.global)[j] = turned(10) * own.slerp(drawn, parent).toRotationMatrix();
  }
  return seen;
}

/// The crops of a scan that is extracted so, of the kinds that are wanted.
void PartSampler::add_crops(const MadeScan& scan, const Extraction& seen,
                            std::array<Crops, nn::kPartKinds>& made) const {
  for (const nn::Part& part : nn::kCroppedParts) {
    if (!kinds_[static_cast<size_t>(part.kind)]) continue;
    const auto crop = nn::cut_part(scan.points, seen, part);
    if (!crop) continue;
    std::array<Label, nn::kPartJoints> truth, before;
    Label none = Label::Zero();
    none[0] = none[4] = 1;
    truth.fill(none);
    before = truth;
    for (size_t k = 0; k < nn::kPartJoints; ++k) {
      const int j = part.corrects[k];
      if (j < 0) continue;
      const Vec3 displacement = (scan.truth.joints.row(j) - seen.joints.row(j)).transpose();
      truth[k] = label_of(scan.truth.global[j], displacement, seen, part);
      before[k] = label_of((*seen.global)[j], Vec3::Zero(), seen, part);
    }
    Crops& to = made[static_cast<size_t>(part.kind)];
    to.crops.push_back(*crop);
    to.truth.push_back(truth);
    to.before.push_back(before);
  }
}

PartBatches PartSampler::next(int scans) {
  std::array<Crops, nn::kPartKinds> made;
  for (int n = 0; n < scans; ++n) {
    const MadeScan scan = makers_[rng_.below(3)].next();
    for (int look = 0; look < kLooks; ++look) add_crops(scan, pretend(scan.truth), made);
  }
  PartBatches batches;
  for (size_t kind = 0; kind < made.size(); ++kind)
    batches[kind] = batch_of(made[kind], static_cast<nn::PartKind>(kind));
  return batches;
}

}  // namespace understudy::training
