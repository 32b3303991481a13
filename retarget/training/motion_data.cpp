#include "retarget/training/motion_data.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr int kStretch = 60;   // frames of a clip that belong to one body
constexpr int kShortest = 17;  // frames: 30 frames at 60 per second of a clip of 30 per second, and one more

/// How far off extracted joints are, against the mean over joints: limbs' ends more than the trunk.
constexpr std::array<float, kJointCount> kErrorShare = {0.7f, 0.8f, 0.8f, 0.7f, 0.9f, 0.9f, 0.7f, 1.1f,
                                                        1.1f, 0.7f, 1.3f, 1.3f, 0.8f, 0.8f, 0.8f, 0.9f,
                                                        0.9f, 0.9f, 1.2f, 1.2f, 1.5f, 1.5f};

void add_lost_limb(std::vector<Joints>& joints, Rng& rng) {
  constexpr std::array<int, 8> kLost = {LeftWrist, RightWrist, LeftElbow, RightElbow,
                                        LeftFoot,  RightFoot,  LeftKnee,  RightKnee};
  const int joint = kLost[rng.below(kLost.size())];
  const int first = rng.below(joints.size());
  const int last = std::min<int>(first + 1 + rng.below(6), joints.size());
  const Vec3 offset = 0.08f * Vec3(rng.normal(), rng.normal(), rng.normal());
  for (int t = first; t < last; ++t) joints[t].row(joint) += offset.transpose();
}

void copy_joints(torch::Tensor& to, int64_t row, const std::vector<Joints>& joints) {
  float* at = to.data_ptr<float>() + row * static_cast<int64_t>(joints.size()) * joints[0].size();
  for (const Joints& j : joints) at = std::copy(j.data(), j.data() + j.size(), at);
}

void copy_rotations(torch::Tensor& to, int64_t row, const std::vector<Rotations>& local) {
  float* at = to.data_ptr<float>() + row * static_cast<int64_t>(local.size()) * kJointCount * 9;
  for (const Rotations& rotations : local)
    for (const Mat3& R : rotations)
      for (int i = 0; i < 9; ++i) *at++ = R(i / 3, i % 3);
}

Joints with_errors(const Joints& rest, float size, Rng& rng) {
  std::vector<Joints> one{rest};
  add_joint_errors(one, size, 1 / kClipRate, rng);
  return one[0];
}

}  // namespace

void add_joint_errors(std::vector<Joints>& joints, float size, float dt, Rng& rng) {
  if (size <= 0) return;
  const float stays = rng.uniform(), drifts = rng.uniform(), jumps = rng.uniform();
  const float all = std::sqrt(stays * stays + drifts * drifts + jumps * jumps) + 1e-6f;
  const float rho = std::exp(-dt / rng.uniform(0.05f, 0.5f)), fresh = std::sqrt(1 - rho * rho);
  const float sigma = size / 1.596f / all;  // a normal 3-vector of sigma 1 is 1.596 long in the mean
  Joints constant, drift;
  for (int i = 0; i < constant.size(); ++i) constant.data()[i] = rng.normal(), drift.data()[i] = rng.normal();
  for (Joints& frame : joints)
    for (int j = 0; j < kJointCount; ++j)
      for (int axis = 0; axis < 3; ++axis) {
        drift(j, axis) = rho * drift(j, axis) + fresh * rng.normal();
        frame(j, axis) += sigma * kErrorShare[j] *
                          (stays * constant(j, axis) + drifts * drift(j, axis) + jumps * rng.normal());
      }
  if (joints.size() > 1 && rng.chance(0.1f)) add_lost_limb(joints, rng);
}

std::vector<float> mean_leg_lengths(const std::vector<Joints>& joints) {
  std::vector<float> means;
  float sum = 0;
  for (const Joints& frame : joints)
    means.push_back((sum += leg_length(frame)) / static_cast<float>(means.size() + 1));
  return means;
}

MotionData::MotionData(const TrainingData& data) : clips_(data.clips), of_clip_(data.clips.size()) {
  for (const auto& betas : data.betas) bodies_.push_back(data.body.shaped(betas).joints);
  for (const auto& dressed : data.dressed) bodies_.push_back(dressed.joints);
  US_CHECK(bodies_.size() >= 2, "motion transfer is learnt from at least two bodies");
  for (Joints& rest : bodies_) rest.rowwise() -= Eigen::RowVector3f(rest.row(Pelvis));

  Rng who(20240321);  // the same stretch has the same body in every run
  for (const ClipRun& run : good_runs(data.clips, kShortest, kStretch)) {
    of_clip_[run.clip].push_back(ssize(stretches_));
    stretches_.push_back({run, who.below(ssize(bodies_))});
  }
  of_clip_.erase(
      std::remove_if(of_clip_.begin(), of_clip_.end(), [](const auto& mine) { return mine.empty(); }),
      of_clip_.end());
  US_CHECK(!stretches_.empty(), "no clip has ", kShortest, " good frames in a row");
}

const MotionData::Stretch& MotionData::random_stretch(Rng& rng) const {
  if (rng.chance(0.5f)) return stretches_[rng.below(stretches_.size())];
  // so that short, rare clips count
  const auto& mine = of_clip_[rng.below(of_clip_.size())];
  return stretches_[mine[rng.below(mine.size())]];
}

MotionData::Sequence MotionData::sequence(const Stretch& stretch, int frames, float step, Rng& rng) const {
  const float start =
      rng.uniform() * (static_cast<float>(stretch.count - 1) - step * static_cast<float>(frames - 1));
  const bool mirror = rng.chance(0.5f);
  const Mat3 yaw = rotation_about_y(rng.uniform(-kPi, kPi));
  Sequence made;
  for (int t = 0; t < frames; ++t) {
    Pose pose;
    pose.local =
        clips_.at(stretch.clip, static_cast<float>(stretch.first) + start + step * static_cast<float>(t))
            .local;
    if (mirror) pose = mirrored(pose);
    pose.local[Pelvis] = yaw * pose.local[Pelvis];
    made.joints.push_back(forward_kinematics(bodies_[stretch.body], pose).joints);
    made.local.push_back(pose.local);
  }
  return made;
}

const MotionData::Stretch& MotionData::stretch_of_another(const Stretch& stretch, Rng& rng) const {
  for (int attempt = 0; attempt < 100; ++attempt)
    if (const Stretch& other = random_stretch(rng); other.body != stretch.body) return other;
  return stretch;
}

void MotionData::fill(MotionBatch& batch, int64_t row, const MotionBatchOptions& options, Rng& rng) const {
  const bool crossed = row < batch.crossed;
  const Stretch& mine = random_stretch(rng);
  const Stretch& other = crossed ? stretch_of_another(mine, rng) : mine;
  const float longest =
      static_cast<float>(std::min(mine.count, other.count) - 1) / static_cast<float>(options.frames - 1);
  // clip frames a frame
  const float step = std::min(longest, rng.chance(0.4f) ? 1.0f : rng.uniform(0.5f, 1.5f));
  const float dt = step / kClipRate;

  Sequence made = sequence(mine, options.frames, step, rng);
  copy_joints(batch.clean, row, made.joints);
  copy_rotations(batch.rotations, row, made.local);
  add_joint_errors(made.joints, rng.chance(0.2f) ? 0.0f : rng.uniform(0, options.noise), dt, rng);
  copy_joints(batch.joints, row, made.joints);
  batch.dt[row].fill_(dt);
  batch.leg[row].copy_(torch::tensor(mean_leg_lengths(made.joints)));

  if (crossed) copy_joints(batch.real, row, sequence(other, options.frames, step, rng).joints);
  const Joints& rest_b = bodies_[other.body];
  copy_joints(batch.rest_a, row, {bodies_[mine.body]});
  copy_joints(batch.rest_b, row, {rest_b});
  const float seen_error = rng.chance(0.5f) ? 0.0f : rng.uniform(0, 0.4f * options.noise);
  copy_joints(batch.seen_b, row, {with_errors(rest_b, seen_error, rng)});
}

MotionBatch MotionData::batch(const MotionBatchOptions& options, Rng& rng) const {
  const int64_t size = options.size, frames = options.frames;
  MotionBatch batch;
  batch.crossed = size / 2;
  batch.joints = torch::empty({size, frames, kJointCount, 3});
  batch.clean = torch::empty_like(batch.joints);
  batch.rotations = torch::empty({size, frames, kJointCount, 3, 3});
  batch.leg = torch::empty({size, frames});
  batch.dt = torch::empty({size, frames});
  batch.rest_a = torch::empty({size, kJointCount, 3});
  batch.rest_b = torch::empty_like(batch.rest_a);
  batch.seen_b = torch::empty_like(batch.rest_a);
  batch.real = torch::empty({batch.crossed, frames, kJointCount, 3});
  for (int64_t row = 0; row < size; ++row) fill(batch, row, options, rng);
  return batch;
}

}  // namespace understudy::training
