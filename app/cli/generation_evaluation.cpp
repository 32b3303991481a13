#include "app/cli/generation_evaluation.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "app/run/interrupt.hpp"
#include "app/run/motion_generator.hpp"
#include "app/run/rig_performance.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/marionette/motion_match.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/metrics/voxel_metrics.hpp"
#include "retarget/rig/person_rig.hpp"

namespace understudy::app {
namespace {

constexpr std::array<int, 7> kApart = {3, 5, 10, 15, 20, 25, 30};
constexpr int kMadePoses = 25;

/// Every so many frames, from the first.
std::vector<PoseKey> keys_apart(const RigMotion& motion, int apart) {
  std::vector<PoseKey> keys;
  for (int t = 0; t < ssize(motion.poses); t += apart)
    keys.push_back({t, motion.poses[static_cast<size_t>(t)]});
  return keys;
}

/// Gap after gap, each of all that is beside it.
std::vector<RigPose> matched_gaps(const RiggedMotion& truth, const std::vector<PoseKey>& keys) {
  const std::vector<RigPose>& poses = truth.motion.poses;
  std::vector<RigPose> made = {poses[0]};
  for (size_t k = 0; k + 1 < keys.size(); ++k) {
    const int first = keys[k].frame, last = keys[k + 1].frame;
    const std::vector<RigMotion> known = {{truth.motion.fps, {poses.begin(), poses.begin() + first + 1}},
                                          {truth.motion.fps, {poses.begin() + last, poses.end()}}};
    MatchOptions options;
    options.frames = last - first + 1;
    options.keys = {{0, keys[k].pose}, {last - first, keys[k + 1].pose}};
    const RigMotion gap = matched_motion(truth.rig, known, options);
    made.insert(made.end(), gap.poses.begin() + 1, gap.poses.end());
  }
  return made;
}

/// What is made by one engine between keys.
using Between = std::function<std::vector<RigPose>(const std::vector<PoseKey>& keys)>;

std::vector<Points> surfaces_of(const understudy::Rig& rig, const std::vector<RigPose>& poses) {
  std::vector<Points> surfaces;
  surfaces.reserve(poses.size());
  for (const RigPose& pose : poses)
    surfaces.push_back(skinned(rig.surface.vertices, rig.skin, bone_motions(rig, pose)));
  return surfaces;
}

void add_gaps(const RiggedMotion& truth, const std::string& engine, const Between& between, Metrics& to) {
  const std::vector<Points> all = surfaces_of(truth.rig, truth.motion.poses);
  double sum = 0;
  for (const int apart : kApart) {
    check_interrupt("while frames were made");
    const std::vector<PoseKey> keys = keys_apart(truth.motion, apart);
    US_CHECK(keys.size() > 1, "a motion of ", truth.motion.poses.size(), " frames has no gaps of ", apart);
    const std::vector<Points> made = surfaces_of(truth.rig, between(keys));
    const std::vector<Points> there(all.begin(), all.begin() + ssize(made));
    const double m_cd = voxel_errors(made, truth.rig.surface.faces, there, truth.rig.surface.faces).m_cd;
    to.emplace_back("m_cd_" + engine + "_" + std::to_string(apart), m_cd);
    sum += m_cd;
  }
  to.emplace_back("m_cd_" + engine, sum / kApart.size());
}

Between by_network(const RiggedMotion& truth, MotionDynamics& dynamics) {
  return [&](const std::vector<PoseKey>& keys) {
    Rng rng(1);
    return dynamics.aimed(keys, 1 / truth.motion.fps, rng);
  };
}

double skate(const understudy::Rig& rig, const std::vector<RigPose>& poses, double fps) {
  JointSequence joints;
  for (const RigPose& pose : poses) joints.push_back(joint_places(rig, bone_motions(rig, pose)));
  return foot_skate(joints, fps);
}

/// How far a person's motion is from the nearest that the training split of a data folder has, metres, as
/// distance_to_nearest().
double distance_to_training(const understudy::Rig& rig, const std::vector<RigPose>& made,
                            const std::string& data) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::string& folder : read_split(data, "train").motion_folders)
    for (const Clip& clip : read_clips(folder)) {
      check_interrupt("while training data was searched");
      if (clip.motion.poses.size() < made.size()) continue;
      std::vector<RigPose> poses;
      for (const Pose& pose : clip.motion.poses) poses.push_back(person_pose(pose));
      nearest = std::min(nearest, distance_to_nearest(rig, made, poses));
    }
  return nearest;
}

/// Goes on from the first poses, as `generate` does.
void add_generation(const RiggedMotion& truth, MotionDynamics& dynamics, const std::string& data,
                    Metrics& to) {
  GenerationOptions options;
  options.engine = "vrnn";
  options.frames = kGivenFrames + kMadePoses;
  const auto load = [&](const understudy::Rig&) { return dynamics.clone(); };
  const auto began = std::chrono::steady_clock::now();
  const GeneratedMotions motions = generate_motions(truth, options, load, [](int) { return true; });
  to.emplace_back("made_ms", ms_since(began));
  const std::vector<RigPose>& poses = motions.motions[0].motion.poses;
  const std::vector<RigPose> made(poses.begin() + kGivenFrames, poses.end());
  to.emplace_back("made_nearest_mm", 1000 * distance_to_nearest(truth.rig, made, truth.motion.poses));
  if (dynamics.kind() != "person") return;
  if (!data.empty())
    to.emplace_back("made_nearest_training_mm", 1000 * distance_to_training(truth.rig, made, data));
  for (const auto& [key, of] : {std::pair{"made_skate", &made}, {"made_skate_true", &truth.motion.poses}}) {
    const double figure = skate(truth.rig, *of, truth.motion.fps);
    if (std::isfinite(figure)) to.emplace_back(key, figure);
  }
}

}  // namespace

void evaluate_generation(const Case& c, const EvalOptions& options, CaseResult& result) {
  const RiggedMotion truth = read_rig(c.rig);
  const std::string folder = nn::weights_folder(network_options(options.how));
  const std::string kind = c.tags.size() > 1 ? c.tags[1] : "";
  result.frames = ssize(truth.motion.poses);
  const auto frames = [](const std::vector<PoseKey>& keys) { return keys.back().frame + 1; };
  add_gaps(
      truth, "lerp", [&](const auto& keys) { return lerp_between(truth.rig, keys, frames(keys)); },
      result.metrics);
  add_gaps(
      truth, "slerp", [&](const auto& keys) { return slerp_between(truth.rig, keys, frames(keys)); },
      result.metrics);
  add_gaps(
      truth, "match", [&](const auto& keys) { return matched_gaps(truth, keys); }, result.metrics);
  for (const bool positions : {false, true}) {
    const std::string file =
        folder + "/marionette_dynamics_" + kind + (positions ? "_positions" : "") + ".weights";
    if (!std::filesystem::exists(file)) continue;
    const std::unique_ptr<MotionDynamics> dynamics = nn::load_motion_dynamics(file, truth.rig);
    add_gaps(truth, positions ? "positions" : "vrnn", by_network(truth, *dynamics), result.metrics);
    if (!positions) add_generation(truth, *dynamics, options.data, result.metrics);
  }
}

}  // namespace understudy::app
