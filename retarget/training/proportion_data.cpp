#include "retarget/training/proportion_data.hpp"

#include "retarget/math/rotation.hpp"
#include "retarget/pose2d/proportion_input.hpp"

namespace understudy::training {
namespace {

constexpr float kOddPeople = 0.6f;                         // share of the people
constexpr float kOtherLegs = 0.15f, kTurnedJoints = 0.3f;  // shares of the poses
constexpr float kTurn = 0.12f;                             // radians about each axis

}  // namespace

std::vector<FlatPerson> flat_people_of(const TrainingData& data) {
  const ShapedBody mean = data.body.shaped(Eigen::VectorXf::Zero(1));
  const HeadVertices head = head_vertices(mean.vertices, mean.joints);
  std::vector<FlatPerson> people;
  for (const Eigen::VectorXf& betas : data.betas) {
    const ShapedBody body = data.body.shaped(betas);
    people.push_back(flat_person(body.vertices, body.joints, head));
  }
  return people;
}

ProportionData::ProportionData(TrainingData data) : data_(std::move(data)), people_(flat_people_of(data_)) {}

FlatPerson ProportionData::random_person(Rng& rng) const {
  const auto any = [&]() -> const FlatPerson& {
    return people_[static_cast<size_t>(rng.below(static_cast<int>(people_.size())))];
  };
  FlatPerson person = any();
  if (rng.chance(0.5f)) person = between(person, any(), rng.uniform());
  return rng.chance(kOddPeople) ? scaled_apart(person, random_scales(rng)) : person;
}

Pose ProportionData::random_posture(Rng& rng) const {
  Pose pose = random_pose(data_, rng);
  if (rng.chance(kOtherLegs)) {
    const Pose& other = random_pose(data_, rng);
    for (const int joint : {LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle})
      pose.local[static_cast<size_t>(joint)] = other.local[static_cast<size_t>(joint)];
  }
  if (rng.chance(kTurnedJoints))
    for (Mat3& local : pose.local) {
      const float x = rng.normal(), y = rng.normal(), z = rng.normal();
      local *= rotation_from_axis_angle(kTurn * Vec3(x, y, z));
    }
  return rng.chance(0.5f) ? mirrored(pose) : pose;
}

ProportionBatch ProportionData::batch(int count, Rng& rng) const {
  ProportionBatch batch{torch::empty({count, kProportionInputs}), torch::empty({count, kFlatBoneCount})};
  float* pose_row = batch.poses.data_ptr<float>();
  float* length_row = batch.log_length.data_ptr<float>();
  for (int i = 0; i < count; ++i, pose_row += kProportionInputs, length_row += kFlatBoneCount) {
    const FlatPerson person = random_person(rng);
    const Pose pose = random_posture(rng);
    const FlatSight sight = seen_flat(person, pose, random_view(pose.root, {}, rng));
    const ProportionInput input = proportion_input(detected(sight, random_errors(rng), rng));
    Eigen::Map<Eigen::Matrix<float, 1, kProportionInputs>>(pose_row, 1, kProportionInputs) = input.numbers;
    Eigen::Map<BoneLengths>(length_row, kFlatBoneCount) = (sight.length / input.size).log();
  }
  return batch;
}

}  // namespace understudy::training
