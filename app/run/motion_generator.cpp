#include "app/run/motion_generator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/discovery/ground_contacts.hpp"
#include "retarget/marionette/motion_match.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::app {
namespace {

constexpr int kMostFrames = 10000, kMostMotions = 100;
constexpr int kTrajectories = 300;  // of the paper's sampling, which has 10,000 on a GPU
constexpr float kHurry = 1.5f;      // times the fastest of the clip: faster is told

std::vector<PoseKey> keys_of(const RiggedMotion& known, const GenerationOptions& options) {
  if (!options.between) return {};
  const std::vector<RigPose>& poses = known.motion.poses;
  return {{0, poses[static_cast<size_t>(options.between->first)]},
          {options.frames - 1, poses[static_cast<size_t>(options.between->last)]}};
}

float over_floor(const RigPose& a, const RigPose& b) {
  const Vec3 way = b.root - a.root;
  return std::hypot(way.x(), way.z());
}

/// Where the keys are farther apart than the clip's body ever went in that time.
std::string hurry_of(const RiggedMotion& known, const GenerationOptions& options, int first_frame) {
  if (!options.between) return "";
  const std::vector<RigPose>& poses = known.motion.poses;
  float fastest = 0;
  for (size_t t = 1; t < poses.size(); ++t) fastest = std::max(fastest, over_floor(poses[t - 1], poses[t]));
  const std::vector<PoseKey> keys = keys_of(known, options);
  const float apart = over_floor(keys[0].pose, keys[1].pose);
  const float needed = apart / static_cast<float>(options.frames - 1);
  if (needed <= kHurry * fastest + 1e-4f) return "";
  return printed(
      "frames %d and %d are %.2f m apart: in %d frames %s goes %.1f m/s, and never above %.1f in "
      "its clip, so feet will slide",
      first_frame + options.between->first, first_frame + options.between->last, static_cast<double>(apart),
      options.frames, known.rig.name.c_str(), static_cast<double>(needed) * known.motion.fps,
      static_cast<double>(fastest) * known.motion.fps);
}

/// As far as a pose is from another: mean distance of joints.
double pose_distance(const understudy::Rig& rig, const RigPose& a, const RigPose& b) {
  return static_cast<double>(
      (joint_places(rig, bone_motions(rig, a)) - joint_places(rig, bone_motions(rig, b)))
          .rowwise()
          .norm()
          .mean());
}

/// Of many that go on from the first key, the one that ends nearest to the last (paper 3).
std::vector<RigPose> best_of_many(const RiggedMotion& known, MotionDynamics& dynamics,
                                  const std::vector<PoseKey>& keys, Rng& rng) {
  const double dt = 1 / known.motion.fps;
  dynamics.begin(known.rig);
  dynamics.observe(keys.front().pose, dt);
  std::vector<RigPose> best;
  double nearest = 0;
  for (int i = 0; i < kTrajectories; ++i) {
    const std::unique_ptr<MotionDynamics> tried = dynamics.clone();
    std::vector<RigPose> poses = {keys.front().pose};
    while (ssize(poses) <= keys.back().frame) poses.push_back(tried->sample(dt, rng));
    const double off = pose_distance(known.rig, poses.back(), keys.back().pose);
    if (!best.empty() && off >= nearest) continue;
    nearest = off;
    best = std::move(poses);
  }
  return best;
}

float lowest_joint(const understudy::Rig& rig, const RigPose& pose) {
  return joint_places(rig, bone_motions(rig, pose)).col(1).minCoeff();
}

/// Says how far from the ground of its clip a body got that a network moves on and on: frame by frame it may
/// rise a little. Nobody is in the air for longer than a while.
class GroundLevel {
 public:
  explicit GroundLevel(const RiggedMotion& known) : rig_(known.rig) {
    std::vector<double> lowest;
    for (const RigPose& pose : known.motion.poses)
      lowest.push_back(static_cast<double>(lowest_joint(rig_, pose)));
    constexpr double kLowestPercent = 10;
    ground_ = static_cast<float>(percentile(lowest, kLowestPercent));
    constexpr double kLongestInAir = 0.7;  // seconds
    most_ = std::max<size_t>(1, static_cast<size_t>(kLongestInAir * known.motion.fps));
  }
  void see(const RigPose& pose) {
    lowest_.push_back(lowest_joint(rig_, pose));
    if (lowest_.size() > most_) lowest_.erase(lowest_.begin());
  }
  /// What takes the body back to it, a part a frame, metres: the last pose is to be raised by it.
  float back() {
    constexpr float kBackAFrame = 0.2f;
    const float raised = kBackAFrame * (ground_ - *std::min_element(lowest_.begin(), lowest_.end()));
    for (float& height : lowest_) height += raised;
    return raised;
  }

 private:
  const understudy::Rig& rig_;
  float ground_ = 0;
  size_t most_ = 1;
  std::vector<float> lowest_;
};

/// What stands, but slides as a network makes it, stands still: the body goes as its feet push it. The poses
/// that were given stay.
void plant_feet(const RiggedMotion& known, size_t given, std::vector<RigPose>& poses) {
  const std::vector<RigPose>& clip = known.motion.poses;
  RiggedMotion both{known.rig, {known.motion.fps, clip}};  // on the clip's ground
  both.motion.poses.insert(both.motion.poses.end(), poses.begin(), poses.end());
  GroundContacts contacts = ground_contacts(both);
  contacts.touches.erase(contacts.touches.begin(), contacts.touches.begin() + ssize(clip));
  both.motion.poses = std::move(poses);
  stand_on(contacts.ground, contacts.touches, both);
  poses = std::move(both.motion.poses);
  std::vector<PoseKey> keys;
  for (size_t t = 0; t < given; ++t) keys.push_back({static_cast<int>(t), clip[t]});
  meet_keys(known.rig, known.motion.fps, keys, poses);
}

/// The clip's first poses, and what may come after them.
std::vector<RigPose> gone_on(const RiggedMotion& known, int frames, MotionDynamics& dynamics, Rng& rng) {
  const double dt = 1 / known.motion.fps;
  dynamics.begin(known.rig);
  const auto given = std::min({kGivenFrames, frames, static_cast<int>(ssize(known.motion.poses))});
  std::vector<RigPose> poses(known.motion.poses.begin(), known.motion.poses.begin() + given);
  GroundLevel level(known);
  for (const RigPose& pose : poses) {
    dynamics.observe(pose, dt);
    level.see(pose);
  }
  const std::string kind = dynamics.kind();
  const bool walks = kind == "person" || kind == "quadruped";  // not a hand in the air
  while (ssize(poses) < frames) {
    poses.push_back(dynamics.sample(dt, rng));
    if (!walks) continue;
    level.see(poses.back());
    const float raised = level.back();
    poses.back().root.y() += raised;
    dynamics.raise(raised);
  }
  if (walks && known.rig.surface.vertices.rows() > 0) plant_feet(known, static_cast<size_t>(given), poses);
  return poses;
}

std::vector<RigPose> made_by_network(const RiggedMotion& known, const GenerationOptions& options,
                                     MotionDynamics& dynamics, uint64_t seed) {
  Rng rng(seed);
  const double dt = 1 / known.motion.fps;
  const std::vector<PoseKey> keys = keys_of(known, options);
  if (!keys.empty()) {
    if (!options.paper_sampling) return dynamics.aimed(keys, dt, rng);
    std::vector<RigPose> poses = best_of_many(known, dynamics, keys, rng);
    meet_keys(known.rig, known.motion.fps, keys, poses);
    return poses;
  }
  return gone_on(known, options.frames, dynamics, rng);
}

std::vector<RigPose> made(const RiggedMotion& known, const GenerationOptions& options,
                          MotionDynamics* dynamics, uint64_t seed) {
  if (dynamics) return made_by_network(known, options, *dynamics, seed);
  const std::vector<PoseKey> keys = keys_of(known, options);
  if (options.engine == "slerp") return slerp_between(known.rig, keys, options.frames);
  if (options.engine == "lerp") return lerp_between(known.rig, keys, options.frames);
  return matched_motion(known.rig, {known.motion}, {options.frames, keys, options.loop, seed}).poses;
}

}  // namespace

const std::vector<GenerationEngine>& generation_engines() {
  static const std::vector<GenerationEngine> all = {
      {"match", "Own motion", "puts pieces of the clip together anew, without training", false, false},
      {"vrnn", "Network", "goes on as a network has learned that bodies of this kind move (paper 3)", false,
       true},
      {"slerp", "Even turns", "turns every joint evenly from one pose to the other", true, false},
      {"lerp", "Straight lines", "leads every joint on a straight line from one pose to the other", true,
       false}};
  return all;
}

const GenerationEngine& generation_engine_named(const std::string& name) {
  std::string names;
  for (const GenerationEngine& engine : generation_engines()) {
    if (name == engine.name) return engine;
    names += names.empty() ? engine.name : std::string(", ") + engine.name;
  }
  throw Error("there is no engine \"" + name + "\" that makes motions, only " + names);
}

void check_generation(const RiggedMotion& known, const GenerationOptions& options) {
  const std::string& name = known.rig.name;
  const GenerationEngine& engine = generation_engine_named(options.engine);
  const auto frames = static_cast<int>(ssize(known.motion.poses));
  US_CHECK(frames >= 2, name, ": has no motion, one pose alone: there is nothing to make more of");
  US_CHECK(options.frames >= 2 && options.frames <= kMostFrames, "a motion has 2 to ", kMostFrames,
           " frames, not ", options.frames);
  US_CHECK(options.count >= 1 && options.count <= kMostMotions, "1 to ", kMostMotions,
           " motions are made at once, not ", options.count);
  if (options.between)
    for (const int frame : {options.between->first, options.between->last})
      US_CHECK(frame >= 0 && frame < frames, name, ": has frames 0 to ", frames - 1, ", so none ", frame,
               " to make a motion between");
  US_CHECK(options.between || !engine.needs_keys, "\"", engine.name,
           "\" makes what lies between two frames alone: tell which");
  US_CHECK(!options.loop || !options.between, "a loop ends as it begins, not between two frames");
  US_CHECK(!options.loop || std::string(engine.name) == "match", "\"", engine.name, "\" makes no loops");
}

GeneratedMotions generate_motions(const RiggedMotion& known, const GenerationOptions& options,
                                  const DynamicsLoader& load, const std::function<bool(int)>& going_on,
                                  int first_frame) {
  check_generation(known, options);
  std::unique_ptr<MotionDynamics> dynamics;
  if (generation_engine_named(options.engine).needs_weights) dynamics = load(known.rig);
  GeneratedMotions all;
  all.remark = hurry_of(known, options, first_frame);
  for (int i = 0; i < options.count && going_on(i); ++i) {
    GeneratedMotion one;
    one.seed = options.seed + static_cast<uint64_t>(i);
    one.motion = {known.motion.fps, made(known, options, dynamics.get(), one.seed)};
    one.nearest_m = distance_to_nearest(known.rig, one.motion.poses, known.motion.poses);
    all.motions.push_back(std::move(one));
  }
  return all;
}

}  // namespace understudy::app
