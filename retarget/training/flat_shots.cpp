#include "retarget/training/flat_shots.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/training/proportion_data.hpp"

namespace understudy::training {
namespace {

constexpr float kShotOdd = 0.4f, kShotBetween = 0.5f;        // shares of the people
constexpr float kTurnedShot = 0.3f, kShotTurn = 0.12f;       // share of the shots; radians about each axis
constexpr float kSlowestShot = 0.75f, kFastestShot = 1.33f;  // of the clip's own rate
constexpr float kTwoMotions = 0.25f;  // share: the trunk does something else than the legs
constexpr float kHalfRate = 0.25f;    // share of the shots
constexpr float kNearestShot = 1.5f;  // metres before the eye

/// What the legs' clip moves where another moves the rest.
constexpr std::array<size_t, 9> kPelvisAndLegs = {Pelvis,    LeftHip,    RightHip, LeftKnee, RightKnee,
                                                  LeftAnkle, RightAnkle, LeftFoot, RightFoot};

/// Poses of the shot, on its person's legs.
std::vector<Pose> shot_poses(const FlatShot& shot, float template_leg) {
  const float leg = leg_length(shot.person.rest) / template_leg;
  std::vector<Pose> poses;
  for (int i = 0; i < shot.frames; ++i) {
    Pose pose = shot.clip->motion.poses[static_cast<size_t>(shot.first + i * shot.step)];
    if (shot.upper) {
      const Pose below = pose;
      pose.local = shot.upper->motion.poses[static_cast<size_t>(shot.upper_first + i * shot.step)].local;
      for (const size_t j : kPelvisAndLegs) pose.local[j] = below.local[j];
    }
    if (shot.mirrored) pose = mirrored(pose);
    pose.root *= leg;
    for (size_t j = 0; j < shot.turned.size(); ++j) pose.local[j] *= shot.turned[j];
    poses.push_back(pose);
  }
  return poses;
}

/// One that nobody comes too near.
Pinhole shot_view(const std::vector<Pose>& poses, Rng& rng) {
  Vec3 middle = Vec3::Zero();
  for (const Pose& pose : poses) middle += pose.root / static_cast<float>(poses.size());
  for (;;) {
    Pinhole camera = random_view(middle, {}, rng);
    const bool is_near = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
      return camera.project(pose.root).z() < kNearestShot;
    });
    if (!is_near || camera.orthographic) return camera;
  }
}

}  // namespace

ShotSight seen_shot(const FlatShot& shot, float template_leg, Rng& rng) {
  ShotSight sight;
  sight.poses = shot_poses(shot, template_leg);
  sight.camera = shot_view(sight.poses, rng);
  sight.dt = static_cast<float>(shot.step) / (shot.clip->motion.fps * shot.speed);
  return sight;
}

FlatShots::FlatShots(TrainingData data, int frames)
    : data_(std::move(data)),
      frames_(frames),
      people_(flat_people_of(data_)),
      runs_(good_runs(data_.clips, frames, std::numeric_limits<int>::max())) {
  US_CHECK(!runs_.empty(), "the data has no clip with ", frames, " frames in a row to learn 2D poses from");
  for (const ClipRun& run : runs_) all_ += run.count;
}

const FlatPerson& FlatShots::anybody(Rng& rng) const {
  return people_[static_cast<size_t>(rng.below(ssize(people_)))];
}

/// Half the time weighed by how long it is.
const ClipRun& FlatShots::any_run(Rng& rng) const {
  size_t at = static_cast<size_t>(rng.below(ssize(runs_)));
  if (rng.chance(0.5f)) {
    int64_t frame = rng.below(static_cast<int>(all_));
    for (at = 0; frame >= runs_[at].count; ++at) frame -= runs_[at].count;
  }
  return runs_[at];
}

FlatShot FlatShots::plain(Rng& rng) const {
  const ClipRun& run = runs_[static_cast<size_t>(rng.below(ssize(runs_)))];
  FlatShot shot;
  shot.person = anybody(rng);
  shot.clip = &clip_of(run);
  shot.frames = frames_;
  shot.first = run.first + rng.below(run.count - frames_ + 1);
  return shot;
}

FlatShot FlatShots::random(Rng& rng) const {
  FlatShot shot;
  shot.person = anybody(rng);
  if (rng.chance(kShotBetween)) shot.person = between(shot.person, anybody(rng), rng.uniform());
  if (rng.chance(kShotOdd)) shot.person = scaled_apart(shot.person, random_scales(rng));
  const ClipRun& run = any_run(rng);
  shot.clip = &clip_of(run);
  shot.frames = frames_;
  shot.step = rng.chance(kHalfRate) && run.count >= 2 * frames_ ? 2 : 1;
  shot.first = run.first + rng.below(run.count - shot.step * (frames_ - 1));
  const ClipRun& other = any_run(rng);
  if (rng.chance(kTwoMotions) && other.count > shot.step * (frames_ - 1)) {
    shot.upper = &clip_of(other);
    shot.upper_first = other.first + rng.below(other.count - shot.step * (frames_ - 1));
  }
  shot.mirrored = rng.chance(0.5f);
  shot.speed = rng.uniform(kSlowestShot, kFastestShot);
  if (rng.chance(kTurnedShot))
    for (Mat3& turned : shot.turned) {
      const float x = rng.normal(), y = rng.normal(), z = rng.normal();
      turned = rotation_from_axis_angle(kShotTurn * Vec3(x, y, z));
    }
  return shot;
}

}  // namespace understudy::training
