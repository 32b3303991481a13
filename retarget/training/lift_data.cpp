#include "retarget/training/lift_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pose2d/lift_input.hpp"

namespace understudy::training {
namespace {

constexpr float kNoFeet = 0.25f, kNoEyesAndEars = 0.1f;  // shares: layouts that lack them
constexpr float kLimbAway = 0.25f;                       // share: a limb is not seen for a while
constexpr float kLimbGoneInAFrame = 0.02f;
constexpr float kBestLengths = 0.01f, kWorstLengths = 0.1f;  // how far those are off that are believed

using PointList = std::array<int, 5>;
constexpr std::array<PointList, 5> kTogether = {
    {{body25::RightElbow, body25::RightWrist, -1, -1, -1},
     {body25::LeftElbow, body25::LeftWrist, -1, -1, -1},
     {body25::RightKnee, body25::RightAnkle, body25::RightBigToe, body25::RightSmallToe, body25::RightHeel},
     {body25::LeftKnee, body25::LeftAnkle, body25::LeftBigToe, body25::LeftSmallToe, body25::LeftHeel},
     {body25::Nose, body25::RightEye, body25::LeftEye, body25::RightEar, body25::LeftEar}}};

/// What is not seen in a sequence, whatever the frame shows.
struct Away {
  bool feet = false, eyes_and_ears = false;
  int limb = -1, from = 0, to = 0;  // not seen in the frames from `from` to before `to`
};

Away random_away(int frames, Rng& rng) {
  Away away;
  away.feet = rng.chance(kNoFeet);
  away.eyes_and_ears = rng.chance(kNoEyesAndEars);
  if (rng.chance(kLimbAway)) {
    away.limb = rng.below(static_cast<int>(kTogether.size()));
    away.from = std::max(0, rng.below(2 * frames) - frames);
    away.to = away.from + 1 + rng.below(2 * frames);
  }
  return away;
}

void forget_away(const Away& away, int frame, FlatPose& pose) {
  const FlatPose whole = pose;
  if (away.feet)
    for (int p = body25::LeftBigToe; p < kBodyPoints; ++p) pose.forget(p);
  if (away.eyes_and_ears)
    for (int p = body25::RightEye; p <= body25::LeftEar; ++p) pose.forget(p);
  if (away.limb >= 0 && frame >= away.from && frame < away.to)
    for (const int p : kTogether[static_cast<size_t>(away.limb)])
      if (p >= 0) pose.forget(p);
  if ((pose.body.col(2).head<kPaperPoints>().array() > 0).count() < 4) pose = whole;
}

/// As a LengthReader might read them off a few poses: both sides alike.
BoneLengths believed_lengths(BoneLengths lengths, float off, Rng& rng) {
  for (int b = 0; b < kFlatBoneCount; ++b)
    if (const int mirror = kFlatBoneMirror[static_cast<size_t>(b)]; mirror >= b) {
      const float wrong = std::exp(off * rng.normal());
      lengths[b] *= wrong;
      if (mirror != b) lengths[mirror] *= wrong;
    }
  return lengths;
}

LiftSequence seen_sequence(const FlatShot& shot, float template_leg, const LiftErrors& errors,
                           const Away& away, Rng& rng) {
  const ShotSight sight = seen_shot(shot, template_leg, rng);
  LiftSequence sequence;
  sequence.dt = sight.dt;
  sequence.pitch = sight.camera.rotation(1, 2);
  sequence.lengths = believed_lengths(lengths_of(shot.person), errors.lengths, rng);
  KeypointFilter filter;
  for (int t = 0; t < shot.frames; ++t) {
    const Pose& pose = sight.poses[static_cast<size_t>(t)];
    FlatPose seen = detected(seen_flat(shot.person, pose, sight.camera), errors.detector, rng);
    forget_away(away, t, seen);
    sequence.poses.push_back(filter.push(&seen, static_cast<double>(sequence.dt)).pose);
    sequence.truth.push_back(lift_truth(forward_kinematics(shot.person.rest, pose), sight.camera));
  }
  return sequence;
}

}  // namespace

LiftSequence lift_sequence(const FlatShot& shot, float template_leg, const LiftErrors& errors, Rng& rng) {
  return seen_sequence(shot, template_leg, errors, {}, rng);
}

LiftBatch empty_lift_batch(int64_t sequences, int64_t frames) {
  return {torch::empty({sequences, frames, kLiftInputs}), torch::empty({sequences, frames, kJointCount, 3}),
          torch::empty({sequences, frames, kJointCount, 6}), torch::empty({sequences, frames})};
}

void put_sequence(const LiftSequence& sequence, int64_t row, LiftBatch& batch) {
  const auto of_row = [row](torch::Tensor& tensor) { return tensor.select(0, row).data_ptr<float>(); };
  float *frames = of_row(batch.frames), *joints = of_row(batch.joints), *turns = of_row(batch.turns),
        *pitch = of_row(batch.pitch);
  LiftInput input;
  for (size_t t = 0; t < sequence.poses.size(); ++t) {
    const LiftFrame frame = input.push(sequence.poses[t], sequence.lengths, sequence.dt);
    const LiftTruth& truth = sequence.truth[t];
    Eigen::Map<Eigen::Matrix<float, 1, kLiftInputs>>(frames, 1, kLiftInputs) = frame.numbers;
    Eigen::Map<Joints>(joints, kJointCount, 3) = truth.joints * (truth.pixels_a_metre / frame.size);
    for (const Mat3& turn : truth.turns) {
      Eigen::Map<Vec6>(turns, 6) = rotation_to_6d(turn);
      turns += 6;
    }
    *pitch++ = sequence.pitch;
    frames += kLiftInputs;
    joints += 3 * kJointCount;
  }
}

LiftData::LiftData(TrainingData data, int frames) : shots_(std::move(data), frames) {}

LiftSequence LiftData::random_sequence(Rng& rng) const {
  const FlatShot shot = shots_.random(rng);
  LiftErrors errors;
  errors.lengths = rng.uniform(kBestLengths, kWorstLengths);
  errors.detector = random_errors(rng);
  if (errors.detector.limbs_missing > 0)
    errors.detector.limbs_missing = kLimbGoneInAFrame;  // whole limbs go for a while, see Away
  const Away away = random_away(shot.frames, rng);
  return seen_sequence(shot, shots_.template_leg(), errors, away, rng);
}

LiftBatch LiftData::batch(int count, Rng& rng) const {
  LiftBatch batch = empty_lift_batch(count, shots_.frames());
  for (int i = 0; i < count; ++i) put_sequence(random_sequence(rng), i, batch);
  return batch;
}

}  // namespace understudy::training
