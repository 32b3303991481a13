#include "app/run/creature_suites.hpp"

#include <algorithm>
#include <cmath>

#include "app/run/case_writer.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/rig_performance.hpp"
#include "app/run/rig_truth_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/capture.hpp"
#include "retarget/body/exact_body.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/rig/person_rig.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr double kFps = 30;
constexpr int kPeople = 10;
constexpr float kCapturedLength = 1.5f;  // metres: the cameras stand about a body as long as that

struct Seeds {
  uint64_t first, count;
};
Seeds seeds_of(const std::string& split) {
  US_CHECK(split == "dev" || split == "train", "creatures have the splits dev and train, not \"", split,
           "\"");
  return split == "dev" ? Seeds{100, 10} : Seeds{0, 100};
}

/// A case and what makes it.
struct CreaturePlan {
  std::string name, kind, motion;
  std::function<RigTruth()> make;
  std::function<understudy::Rig()> rig = {};  ///< in names and kinds of joints; empty: a person's
};

RigTruth creature_truth(CreatureKind kind, uint64_t seed, int motion, int frames) {
  const understudy::Rig rig = make_creature(kind, seed);
  const RiggedMotion performed{rig, creature_motion(kind, rig, motion, frames, kFps, seed)};
  RigTruth truth = truth_of(performed);
  truth.vertices = creature_surfaces(kind, rig, performed.motion, seed);  // with what the bones do not move
  return truth;
}

CreaturePlan creature_plan(size_t which, uint64_t seed, int frames) {
  const auto kind = static_cast<CreatureKind>(which);
  const std::vector<std::string>& motions = creature_motions(kind);
  const auto motion = static_cast<size_t>(seed % motions.size());
  return {printed("%s%03d_%s", kCreatureNames[which], static_cast<int>(seed), motions[motion].c_str()),
          kCreatureNames[which], motions[motion],
          [=] { return creature_truth(kind, seed, static_cast<int>(motion), frames); },
          [=] { return make_creature(kind, seed); }};
}

/// Of the joints where they are at rest.
understudy::Rig person_of(const RigTruth& truth) {
  Joints rest;
  for (int j = 0; j < kJointCount; ++j)
    rest.row(j) =
        truth.bones[0][static_cast<size_t>(j)].inverse()(truth.joints[0].row(j).transpose()).transpose();
  understudy::Rig rig = person_rig(rest);
  rig.surface = {truth.rest, truth.faces};
  rig.skin = SkinWeights::from(truth.weights);
  return rig;
}

/// A rig with a clip, and nothing else.
void make_rig_case(const CreaturePlan& plan, const SuiteOptions& options) {
  const fs::path folder = fs::path(options.out) / plan.name;
  fs::create_directories(folder);
  const RigTruth truth = plan.make();
  RiggedMotion performed{plan.rig ? plan.rig() : person_of(truth), {kFps, {}}};
  for (const BoneMotions& bones : truth.bones)
    performed.motion.poses.push_back(pose_of(performed.rig, bones));
  write_rig((folder / "rig.glb").string(), performed);
  write_json((folder / "case.json").string(),
             {{"fps", kFps}, {"rig", "rig.glb"}, {"tags", {options.suite, plan.kind, plan.motion}}});
}

bool is_of_gaps(const SuiteOptions& options) {
  return options.suite == "marionette-gaps";
}

/// Whether a network learns how a kind moves.
bool has_dynamics(size_t kind) {
  const auto which = static_cast<CreatureKind>(kind);
  return which == CreatureKind::Arm || which == CreatureKind::Hand || which == CreatureKind::Quadruped;
}

/// A creature, and another of its kind that shall perform what it did.
struct PairPlan {
  size_t kind;
  uint64_t source, target;  // seeds
  std::string name() const {
    return printed("%s%03d_as_%03d", kCreatureNames[kind], static_cast<int>(target),
                   static_cast<int>(source));
  }
};

/// Of left and right hands no two of different sides: angles of the one say nothing of the other.
bool on_one_side(const understudy::Rig& a, const understudy::Rig& b) {
  float same = 0;
  for (size_t j = 0; j < a.joints.size(); ++j)
    same += (a.joints[j].rest.x() - a.joints[0].rest.x()) * (b.joints[j].rest.x() - b.joints[0].rest.x());
  return same >= 0;
}

PairPlan pair_plan(size_t which, uint64_t seed, const Seeds& seeds) {
  const auto kind = static_cast<CreatureKind>(which);
  const understudy::Rig source = make_creature(kind, seed);
  for (uint64_t i = 1; i < seeds.count; ++i) {
    const uint64_t other = seeds.first + (seed - seeds.first + i) % seeds.count;
    if (on_one_side(source, make_creature(kind, other))) return {which, seed, other};
  }
  throw Error(printed("%s %d is alone", kCreatureNames[which], static_cast<int>(seed)));
}

/// The target under the source's true angles.
RigTruth performed_truth(CreatureKind kind, const PairPlan& plan, const RigMotion& motion) {
  const understudy::Rig source = make_creature(kind, plan.source), target = make_creature(kind, plan.target);
  const float scale = box_diagonal(target.surface.vertices) / box_diagonal(source.surface.vertices);
  RiggedMotion performed{target, motion};
  for (RigPose& pose : performed.motion.poses) {
    pose.root = target.joints[0].rest + scale * (pose.root - source.joints[0].rest);
    for (float& slide : pose.slides) slide *= scale;
  }
  return truth_of(performed);
}

/// Bodies of the data folder, as the suite naked has them.
class People {
 public:
  People(const SuiteOptions& options, const DataSplit& split)
      : frames_(options.frames),
        split_(split),
        body_(read_smpl_body(options.body.empty() ? split.body : options.body)),
        shapes_(body_),
        template_leg_(shapes_.shaped({}).leg()) {
    US_CHECK(!split.betas.empty() && !split.motions.empty(), options.data, ": the split \"", options.split,
             "\" has no people or no motions");
  }

  CreaturePlan plan(size_t number) const {
    const EvaluatedMotion& motion = split_.motions[number % split_.motions.size()];
    return {printed("person%03zu_%s", number, motion.tag.c_str()), "person", motion.tag,
            [this, number, motion] { return truth(number, motion); }};
  }

 private:
  RigTruth truth(size_t number, const EvaluatedMotion& clip) const {
    const ExactPerson person = shapes_.shaped(split_.betas[7 * number % split_.betas.size()]);
    const ExactMotion motion = read_exact_motion(clip.path, clip.start, frames_);
    const Performance shown = perform(person, motion, person.leg() / template_leg_);
    RigTruth truth;
    truth.faces = person.faces;
    truth.rest = person.vertices.cast<float>();
    truth.weights = person.weights;
    truth.parents.assign(kParents.begin(), kParents.end());
    truth.axes.assign(kJointCount, Vec3::Zero());
    for (size_t t = 0; t < shown.vertices.size(); ++t) {
      truth.vertices.emplace_back(shown.vertices[t].cast<float>());
      truth.joints.emplace_back(shown.joints[t].cast<float>());
      truth.bones.push_back(bones(person, motion.local[t], shown.joints[t]));
    }
    return truth;
  }

  static BoneMotions bones(const ExactPerson& person, const Rotations64& local, const Joints64& joints) {
    BoneMotions bones(kJointCount);
    std::array<Eigen::Matrix3d, kJointCount> global;
    for (int j = 0; j < kJointCount; ++j) {
      global[j] = j == 0 ? local[j] : Eigen::Matrix3d(global[kParents[j]] * local[j]);
      const Eigen::Vector3d t = joints.row(j).transpose() - global[j] * person.joints.row(j).transpose();
      bones[j] = {global[j].cast<float>(), t.cast<float>()};
    }
    return bones;
  }

  int frames_;
  const DataSplit& split_;
  Body body_;
  ExactBody shapes_;
  double template_leg_;
};

/// Points drawn evenly on the surface, about so many, in no order.
Points even_scan(NumpyRandom& random, const Points& vertices, const Faces& faces, int points) {
  const auto count = static_cast<int64_t>(points * random.uniform(0.8, 1.2));
  return points_on_surface(random, vertices.cast<double>(), faces, count).cast<float>();
}

float longest_side(const Points& vertices) {
  return (vertices.colwise().maxCoeff() - vertices.colwise().minCoeff()).maxCoeff();
}

bool is_captured(const SuiteOptions& options) {
  return options.suite == "creatures-captured";
}

void write_scans(const fs::path& folder, const RigTruth& truth, const SuiteOptions& options, uint64_t seed) {
  make_scan_folder(folder);
  NumpyRandom random(seed);
  CaptureOptions capture;
  capture.points = options.points;
  capture.seed = seed;
  const float scale = kCapturedLength / longest_side(truth.vertices[0]);
  for (int t = 0; t < truth.frames(); ++t)
    write_scan(
        folder, static_cast<size_t>(t),
        !is_captured(options)
            ? even_scan(random, truth.vertices[t], truth.faces, options.points)
            : Points(simulated_capture(scale * truth.vertices[t], truth.faces, t, capture).vertices / scale));
}

void make_case(const CreaturePlan& plan, const SuiteOptions& options) {
  const fs::path folder = fs::path(options.out) / plan.name;
  const RigTruth truth = plan.make();
  write_scans(folder / "source", truth, options, case_seed(plan.name, options.seed));
  write_npz((folder / "truth.npz").string(), rig_truth_arrays(truth));
  write_json((folder / "case.json").string(), {{"fps", kFps},
                                               {"source", "source"},
                                               {"truth", "truth.npz"},
                                               {"tags", {options.suite, plan.kind, plan.motion}}});
}

void make_pair_case(const PairPlan& plan, const SuiteOptions& options) {
  const fs::path folder = fs::path(options.out) / plan.name();
  const auto kind = static_cast<CreatureKind>(plan.kind);
  const auto motion_of = [&](uint64_t seed) {
    return static_cast<int>(seed % creature_motions(kind).size());
  };
  const RigTruth source = creature_truth(kind, plan.source, motion_of(plan.source), options.frames),
                 target = creature_truth(kind, plan.target, motion_of(plan.target), options.frames);
  const RigMotion motion = creature_motion(kind, make_creature(kind, plan.source), motion_of(plan.source),
                                           options.frames, kFps, plan.source);
  write_scans(folder / "source", source, options, case_seed(plan.name(), options.seed));
  write_scans(folder / "target", target, options, case_seed(plan.name() + " target", options.seed));
  write_npz((folder / "truth.npz").string(), rig_truth_arrays(source));
  write_npz((folder / "target.npz").string(), rig_truth_arrays(target));
  write_npz((folder / "performed.npz").string(), rig_truth_arrays(performed_truth(kind, plan, motion)));
  write_json((folder / "case.json").string(),
             {{"fps", kFps},
              {"source", "source"},
              {"truth", "truth.npz"},
              {"target", "target"},
              {"target_truth", "target.npz"},
              {"performed_truth", "performed.npz"},
              {"tags",
               {options.suite, kCreatureNames[plan.kind],
                creature_motions(kind)[static_cast<size_t>(motion_of(plan.source))]}}});
}

int make_pairs(const SuiteOptions& options, const std::function<void(const std::string&)>& done) {
  const Seeds seeds = seeds_of(options.split);
  int made = 0;
  for (uint64_t i = 0; i < seeds.count; ++i)
    for (size_t kind = 0; kind < kCreatureNames.size(); ++kind) {
      if (options.cases > 0 && made == options.cases) return made;
      const PairPlan plan = pair_plan(kind, seeds.first + i, seeds);
      check_interrupt("before case " + plan.name());
      make_pair_case(plan, options);
      done(plan.name());
      ++made;
    }
  return made;
}

}  // namespace

bool is_creature_suite(const std::string& suite) {
  return suite == "creatures" || suite == "creatures-captured" || suite == "creatures-pairs" ||
         suite == "marionette-gaps";
}

int make_creature_suite(const SuiteOptions& options, const std::optional<DataSplit>& people,
                        const std::function<void(const std::string&)>& done) {
  US_CHECK(options.points >= 100, "a scan of ", options.points, " points shows nothing: at least 100");
  if (options.suite == "creatures-pairs") return make_pairs(options, done);
  const Seeds seeds = seeds_of(options.split);
  std::optional<People> person;
  if (people) person.emplace(options, *people);
  std::vector<CreaturePlan> plans;  // a seed of each kind after the other: few cases show all kinds
  for (uint64_t i = 0; i < seeds.count; ++i) {
    for (size_t kind = 0; kind < kCreatureNames.size(); ++kind)
      if (!is_of_gaps(options) || has_dynamics(kind))
        plans.push_back(creature_plan(kind, seeds.first + i, options.frames));
    if (person && i < kPeople) plans.push_back(person->plan(i));
  }
  if (options.cases > 0 && ssize(plans) > options.cases) plans.resize(options.cases);
  for (const CreaturePlan& plan : plans) {
    check_interrupt("before case " + plan.name);
    is_of_gaps(options) ? make_rig_case(plan, options) : make_case(plan, options);
    done(plan.name);
  }
  return static_cast<int>(plans.size());
}

}  // namespace understudy::app
