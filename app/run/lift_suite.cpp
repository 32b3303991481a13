#include "app/run/lift_suite.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/run/case_writer.hpp"
#include "app/run/flat_cast.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"

namespace understudy::app {
namespace {
namespace fs = std::filesystem;

constexpr int kLiftPairs = 30;
constexpr float kLiftJitter_m = 0.015f, kLiftNearest_m = 1.5f;

/// One that nobody comes too near.
Pinhole lift_view(const std::vector<Pose>& poses, Rng& rng) {
  for (;;) {
    Pinhole camera = random_view(middle_of(poses), {}, rng);
    const bool is_near = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
      return camera.project(pose.root).z() < kLiftNearest_m;
    });
    if (!is_near || camera.orthographic) return camera;
  }
}

KeypointReading seen_by(const Pinhole& camera, const FlatPerson& person, const std::vector<Pose>& poses,
                        bool noisy, Rng& rng) {
  KeypointReading seen;
  seen.fps = static_cast<double>(kFlatRate);
  seen.canvas = {static_cast<int>(2 * camera.centre.x()), static_cast<int>(2 * camera.centre.y())};
  seen.tracks.resize(1);
  seen.tracks[0].person = 1;
  DetectorErrors errors;
  errors.jitter_m = kLiftJitter_m;
  for (size_t t = 0; t < poses.size(); ++t) {
    const FlatSight sight = seen_flat(person, poses[t], camera);
    KeypointFrame frame;
    frame.number = static_cast<int64_t>(t);
    seen.frames.push_back(frame);
    TrackedPose tracked;
    tracked.frame = frame.number;
    tracked.pose = noisy ? detected(sight, errors, rng) : sight.pose;
    seen.tracks[0].poses.push_back(std::move(tracked));
  }
  return seen;
}

/// As the camera has it.
std::vector<Pose> before(const Pinhole& camera, std::vector<Pose> poses) {
  const Mat3 turn = camera.rotation.transpose();
  for (Pose& pose : poses) {
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    pose.root = turn * (pose.root - camera.position);
  }
  return poses;
}

/// Vertical, degrees; the narrowest that a lifter takes where there is no perspective.
NpyArray fov_of(const Pinhole& camera) {
  const float fov = 2 * std::atan(camera.centre.y() / camera.focal) * 180 / kPi;
  NpyArray array;
  array.shape = {1};
  array.values = {camera.orthographic ? 1 : fov};
  return array;
}

std::vector<Joints> joints_of(const Joints& rest, const std::vector<Pose>& poses) {
  std::vector<Joints> joints;
  joints.reserve(poses.size());
  for (const Pose& pose : poses) joints.push_back(forward_kinematics(rest, pose).joints);
  return joints;
}

void write_lift_case(const fs::path& folder, const KeypointReading& seen, const ExactPerson& target,
                     const Npz& truth, bool noisy) {
  fs::create_directories(folder);
  write_keypoint_npz((folder / "source.npz").string(), seen);
  write_target((folder / "target.obj").string(), target);
  write_npz((folder / "truth.npz").string(), truth);
  write_json((folder / "case.json").string(), {{"fps", kFlatRate},
                                               {"source", "source.npz"},
                                               {"target", "target.obj"},
                                               {"truth", "truth.npz"},
                                               {"lifted", true},
                                               {"tags", {"lifting", noisy ? "noisy" : "clean"}}});
}

}  // namespace

bool is_lift_suite(const std::string& suite) {
  return suite == "lifting";
}

int make_lift_suite(const SuiteOptions& options, const std::function<void(const std::string&)>& done) {
  const FlatCast cast(options, 0);
  const ExactBody shapes(cast.body());
  const float mean_leg = leg_length(cast.body().shaped({}).joints);
  const int pairs = options.cases > 0 ? options.cases : kLiftPairs;
  for (int pair = 0; pair < pairs; ++pair) {
    check_interrupt("before pair " + std::to_string(pair));
    Rng rng(case_seed(std::to_string(pair), options.seed));
    const int a = rng.below(cast.people()), b = (a + 1 + rng.below(cast.people() - 1)) % cast.people();
    const FlatPerson source = cast.person(a);
    std::vector<Pose> poses = cast.poses(rng.below(cast.runs()), options.frames, kFlatRate);
    for (Pose& pose : poses) pose.root *= leg_length(source.rest) / mean_leg;
    const Pinhole camera = lift_view(poses, rng);
    const std::vector<Pose> shown = before(camera, poses);
    const ExactPerson target = shapes.shaped(cast.betas(b));
    std::vector<Rotations> local;
    local.reserve(shown.size());
    for (const Pose& pose : shown) local.push_back(pose.local);
    Npz truth{{"rotations", rotations_array(local)},
              {"source_joints", frames_array(joints_of(source.rest, shown), {kJointCount, 3})},
              {"joints", frames_array(joints_of(cast.person(b).rest, shown), {kJointCount, 3})},
              {"target_joints", frames_array(std::vector<Joints64>{target.joints}, {kJointCount, 3})}};
    truth["target_joints"].shape = {kJointCount, 3};
    truth["fov_deg"] = fov_of(camera);
    for (const bool noisy : {false, true}) {
      const std::string name = printed("%03d_%s", pair, noisy ? "noisy" : "clean");
      write_lift_case(fs::path(options.out) / name, seen_by(camera, source, poses, noisy, rng), target, truth,
                      noisy);
      done(name);
    }
  }
  return 2 * pairs;
}

}  // namespace understudy::app
