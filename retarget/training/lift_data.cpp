#include "retarget/training/lift_data.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pose2d/lift_input.hpp"
#include "retarget/training/proportion_data.hpp"

namespace understudy::training {
namespace {

constexpr float kLiftedOdd = 0.4f, kLiftedBetween = 0.5f;   // shares of the people
constexpr float kTurnedLifted = 0.3f, kLiftedTurn = 0.12f;  // share of the sequences; radians about each axis
constexpr float kLiftedSlowest = 0.75f, kLiftedFastest = 1.33f;  // of the clip's own rate
constexpr float kHalfRate = 0.25f;                               // share of the sequences
constexpr float kNearestLifted = 1.5f;                           // metres before the eye
constexpr float kNoFeet = 0.25f, kNoEyesAndEars = 0.1f;          // shares: layouts that lack them
constexpr float kLimbAway = 0.25f;                               // share: a limb is not seen for a while
constexpr float kLimbGoneInAFrame = 0.02f;

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

/// Poses of the shot, on its person's legs.
std::vector<Pose> poses_of(const LiftShot& shot, float template_leg) {
  const float leg = leg_length(shot.person.rest) / template_leg;
  std::vector<Pose> poses;
  for (int i = 0; i < shot.frames; ++i) {
    Pose pose = shot.clip->motion.poses[static_cast<size_t>(shot.first + i * shot.step)];
    if (shot.mirrored) pose = mirrored(pose);
    pose.root *= leg;
    for (size_t j = 0; j < shot.turned.size(); ++j) pose.local[j] *= shot.turned[j];
    poses.push_back(pose);
  }
  return poses;
}

/// One that nobody comes too near.
Pinhole view_of(const std::vector<Pose>& poses, Rng& rng) {
  Vec3 middle = Vec3::Zero();
  for (const Pose& pose : poses) middle += pose.root / static_cast<float>(poses.size());
  for (;;) {
    Pinhole camera = random_view(middle, {}, rng);
    const bool is_near = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
      return camera.project(pose.root).z() < kNearestLifted;
    });
    if (!is_near || camera.orthographic) return camera;
  }
}

LiftSequence seen_sequence(const LiftShot& shot, float template_leg, const DetectorErrors& errors,
                           const Away& away, Rng& rng) {
  const std::vector<Pose> poses = poses_of(shot, template_leg);
  const Pinhole camera = view_of(poses, rng);
  LiftSequence sequence;
  sequence.dt = static_cast<float>(shot.step) / (shot.clip->motion.fps * shot.speed);
  sequence.pitch = camera.rotation(1, 2);
  KeypointFilter filter;
  for (int t = 0; t < shot.frames; ++t) {
    const Pose& pose = poses[static_cast<size_t>(t)];
    const FlatSight sight = seen_flat(shot.person, pose, camera);
    FlatPose seen = detected(sight, errors, rng);
    forget_away(away, t, seen);
    sequence.poses.push_back(filter.push(&seen, static_cast<double>(sequence.dt)).pose);
    sequence.truth.push_back(lift_truth(forward_kinematics(shot.person.rest, pose), camera));
  }
  return sequence;
}

}  // namespace

LiftSequence lift_sequence(const LiftShot& shot, float template_leg, const DetectorErrors& errors, Rng& rng) {
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
    const LiftFrame frame = input.push(sequence.poses[t], sequence.dt);
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

LiftData::LiftData(TrainingData data, int frames)
    : data_(std::move(data)),
      frames_(frames),
      people_(flat_people_of(data_)),
      runs_(good_runs(data_.clips, frames, std::numeric_limits<int>::max())) {
  US_CHECK(!runs_.empty(), "the data has no clip with ", frames, " frames in a row to learn lifting from");
  for (const ClipRun& run : runs_) all_ += run.count;
}

LiftSequence LiftData::random_sequence(Rng& rng) const {
  const auto any = [&]() -> const FlatPerson& {
    return people_[static_cast<size_t>(rng.below(ssize(people_)))];
  };
  LiftShot shot;
  shot.person = any();
  if (rng.chance(kLiftedBetween)) shot.person = between(shot.person, any(), rng.uniform());
  if (rng.chance(kLiftedOdd)) shot.person = scaled_apart(shot.person, random_scales(rng));
  size_t at = static_cast<size_t>(rng.below(ssize(runs_)));
  if (rng.chance(0.5f)) {  // weighed by how long it is
    int64_t frame = rng.below(static_cast<int>(all_));
    for (at = 0; frame >= runs_[at].count; ++at) frame -= runs_[at].count;
  }
  const ClipRun& run = runs_[at];
  shot.clip = &data_.clips[static_cast<size_t>(run.clip)];
  shot.frames = frames_;
  shot.step = rng.chance(kHalfRate) && run.count >= 2 * frames_ ? 2 : 1;
  shot.first = run.first + rng.below(run.count - shot.step * (frames_ - 1));
  shot.mirrored = rng.chance(0.5f);
  shot.speed = rng.uniform(kLiftedSlowest, kLiftedFastest);
  if (rng.chance(kTurnedLifted))
    for (Mat3& turned : shot.turned) {
      const float x = rng.normal(), y = rng.normal(), z = rng.normal();
      turned = rotation_from_axis_angle(kLiftedTurn * Vec3(x, y, z));
    }
  DetectorErrors errors = random_errors(rng);
  if (errors.limbs_missing > 0)
    errors.limbs_missing = kLimbGoneInAFrame;  // whole limbs go for a while, see Away
  const Away away = random_away(frames_, rng);
  return seen_sequence(shot, data_.template_leg, errors, away, rng);
}

LiftBatch LiftData::batch(int count, Rng& rng) const {
  LiftBatch batch = empty_lift_batch(count, frames_);
  for (int i = 0; i < count; ++i) put_sequence(random_sequence(rng), i, batch);
  return batch;
}

}  // namespace understudy::training
