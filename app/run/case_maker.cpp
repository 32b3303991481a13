#include "app/run/case_maker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/run/capture_suites.hpp"
#include "app/run/case_writer.hpp"
#include "app/run/creature_suites.hpp"
#include "app/run/flat_suite.hpp"
#include "app/run/inbetween_suite.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/lift_suite.hpp"
#include "app/run/report.hpp"
#include "app/run/sparse_suite.hpp"
#include "app/run/style_suite.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/numpy_random.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/costume.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/body/exact_body.hpp"
#include "retarget/body/hand_poses.hpp"
#include "retarget/metrics/hand_contact.hpp"
#include "retarget/metrics/joint_metrics.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kExtractionCases = 40, kExtractionFrames = 12, kTargets = 4, kMotions = 4;
constexpr int kHandFrames = 45, kHandPeriod = 60;  // from one pose to another and back
constexpr int kBendFrames = 24;                    // from straight to bent and back

/// Which person performs which motion for which target.
struct CasePlan {
  std::string name;
  EvaluatedMotion motion;
  std::optional<Eigen::VectorXf> target;  // shape parameters,
  std::string dressed_target;             // or a file
  Eigen::VectorXf source;
  std::string dressed_source;  // in place of the shape, where not empty
  size_t occlusion = 0;        // number in kOcclusions, of the suite "occluded"
};

/// What makes people hard to see.
struct Occlusion {
  const char* name;
  void (*put)(LabelledPoints& cloud, const PosedSkeleton& truth, Rng& rng);
};
constexpr std::array<Occlusion, 6> kOcclusions = {
    {{"skirt", wear_skirt},
     {"coat", wear_coat},
     {"hair", wear_hair},
     {"held", hold_thing},
     {"one-sided", see_from_one_side},
     {"limbless", [](LabelledPoints& cloud, const PosedSkeleton&, Rng& rng) { lose_limb(cloud, rng); }}}};

bool has_joints_only(const std::string& suite) {
  return suite == "extraction" || suite == "occluded";
}

/// A whole suite's data.
struct Workshop {
  const SuiteOptions& options;
  DataSplit split;
  Body body;
  ExactBody shapes;
  double template_leg;
  std::optional<HandPoses> hands;  // of the suite "hands"
  NumpyRandom random;

  Workshop(const SuiteOptions& wanted, DataSplit read)
      : options(wanted),
        split(std::move(read)),
        body(read_smpl_body(wanted.body.empty() ? split.body : wanted.body)),
        shapes(body),
        template_leg(shapes.shaped({}).leg()),
        random(wanted.seed) {
    if (wanted.suite != "hands") return;
    US_CHECK(!split.hand_poses.empty(), wanted.data, ": has no hand poses, but the suite hands needs them");
    hands.emplace(split.hand_poses);
  }
};

/// Volume over height cubed.
double girth(const ExactPerson& person, double height) {
  double volume = 0;
  for (Eigen::Index f = 0; f < person.faces.rows(); ++f) {
    const Vector3d a = person.vertices.row(person.faces(f, 0)), b = person.vertices.row(person.faces(f, 1)),
                   c = person.vertices.row(person.faces(f, 2));
    volume += a.cross(b).dot(c) / 6;
  }
  return volume / (height * height * height);
}

/// The tallest, shortest, heaviest and slimmest of the split, by their names.
std::array<std::pair<std::string, Eigen::VectorXf>, kTargets> extremes(const Workshop& shop) {
  std::vector<double> heights, girths;
  for (const auto& betas : shop.split.betas) {
    const ExactPerson person = shop.shapes.shaped(betas);
    heights.push_back(person.vertices.col(1).maxCoeff() - person.vertices.col(1).minCoeff());
    girths.push_back(girth(person, heights.back()));
  }
  const auto most = [&](const std::vector<double>& of) {
    return shop.split.betas[std::max_element(of.begin(), of.end()) - of.begin()];
  };
  const auto least = [&](const std::vector<double>& of) {
    return shop.split.betas[std::min_element(of.begin(), of.end()) - of.begin()];
  };
  return {
      {{"tall", most(heights)}, {"short", least(heights)}, {"heavy", most(girths)}, {"slim", least(girths)}}};
}

std::vector<CasePlan> extraction_plans(const Workshop& shop) {
  const auto& [betas, motions] = std::tie(shop.split.betas, shop.split.motions);
  std::vector<CasePlan> plans;
  for (size_t i = 0; i < kExtractionCases; ++i) {
    plans.push_back({printed("b%02zu", i), motions[i % motions.size()], {}, "", betas[i % betas.size()], ""});
    if (shop.options.suite != "occluded") continue;
    plans.back().occlusion = i % kOcclusions.size();
    // Each occlusion meets other motions and people than the ones before.
    plans.back().motion = motions[(i + i / kOcclusions.size()) % motions.size()];
    plans.back().name += std::string("_") + kOcclusions[plans.back().occlusion].name;
  }
  return plans;
}

/// The four extremes and four more people, each shown the same bends.
std::vector<CasePlan> bend_plans(const Workshop& shop) {
  const auto& betas = shop.split.betas;
  std::vector<CasePlan> plans;
  const auto add = [&](const std::string& name, const Eigen::VectorXf& target) {
    plans.push_back({name, {"", 0, "bends"}, target, "", betas[(7 * plans.size()) % betas.size()], ""});
  };
  for (const auto& [name, target] : extremes(shop)) add(name, target);
  for (size_t i = 0; i < kTargets; ++i) {
    const size_t row = i * betas.size() / kTargets;
    add("b" + std::to_string(row), betas[row]);
  }
  return plans;
}

std::vector<CasePlan> performance_plans(const Workshop& shop) {
  const DataSplit& split = shop.split;
  const bool captured = shop.options.suite == "captured";
  std::vector<CasePlan> targets;
  if (shop.options.suite == "clothed") {
    for (size_t i = 0; i < split.clothed.size() && i < kTargets; ++i)
      targets.push_back({fs::path(split.clothed[i]).stem().string(), {}, {}, split.clothed[i], {}, ""});
  } else {
    for (auto& [name, betas] : extremes(shop)) targets.push_back({name, {}, betas, "", {}, ""});
  }
  std::vector<CasePlan> plans;
  for (size_t i = 0; i < targets.size(); ++i)
    for (size_t k = 0; k < split.motions.size() && k < kMotions; ++k) {
      CasePlan plan = targets[i];
      plan.motion = split.motions[k];
      plan.name += "_" + plan.motion.tag;
      plan.source = split.betas[(7 * i + k) % split.betas.size()];
      if (captured) plan.dressed_source = split.clothed[(5 * i + k) % split.clothed.size()];
      plans.push_back(std::move(plan));
    }
  return plans;
}

Points64 picked_rows(const Points64& points, const std::vector<int64_t>& rows) {
  Points64 picked(rows.size(), 3);
  for (size_t i = 0; i < rows.size(); ++i) picked.row(i) = points.row(rows[i]);
  return picked;
}

/// What a rig sees of the points: the side towards `view` densely, nothing in a few holes.
Points64 seen(NumpyRandom& random, const Points64& points) {
  Vector3d view;
  for (double& x : view) x = random.normal();
  view.normalize();
  const Eigen::RowVector3d mean = points.colwise().mean();
  std::vector<bool> keep(points.rows());
  for (int64_t i = 0; i < points.rows(); ++i)
    keep[i] = random.random() < 0.35 + 0.65 / (1 + std::exp(-6 * (points.row(i) - mean).dot(view)));
  for (int64_t hole = random.integers(1, 5); hole > 0; --hole) {
    const Eigen::RowVector3d centre = points.row(random.integers(0, points.rows()));
    const double radius = random.uniform(0.03, 0.10);
    for (int64_t i = 0; i < points.rows(); ++i)
      if ((points.row(i) - centre).norm() <= radius) keep[i] = false;
  }
  std::vector<int64_t> rows;
  for (size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) rows.push_back(static_cast<int64_t>(i));
  return picked_rows(points, rows);
}

/// Points as a multi-view rig gives them: density by view, holes, noise, outliers, a bit of floor.
Points64 captured(NumpyRandom& random, const Points64& vertices, const Faces& faces, int64_t count) {
  Points64 points = seen(random, points_on_surface(random, vertices, faces, 2 * count));
  const auto most = static_cast<int64_t>(static_cast<double>(count) * random.uniform(0.6, 1.0));
  points.conservativeResize(std::min<int64_t>(points.rows(), most), 3);
  for (int64_t i = 0; i < points.size(); ++i) points.data()[i] += 0.004 * random.normal();
  const Eigen::RowVector3d low = points.colwise().minCoeff().array() - 0.1,
                           high = points.colwise().maxCoeff().array() + 0.1;
  const auto scatter = [&](int64_t many) {
    const int64_t before = points.rows();
    points.conservativeResize(before + many, 3);
    for (int64_t i = before; i < points.rows(); ++i)
      for (int axis = 0; axis < 3; ++axis) points(i, axis) = random.uniform(low[axis], high[axis]);
  };
  scatter(std::max<int64_t>(1, points.rows() / 400));
  const int64_t floor = points.rows() / 60;
  scatter(floor);
  for (int64_t i = points.rows() - floor; i < points.rows(); ++i) points(i, 1) = 0.003 * random.normal();
  return points;
}

/// The points as they are when the person is hard to see: the same skirt, thing or side in every frame.
Points64 occluded(const CasePlan& plan, const Points64& points, const Joints64& joints,
                  const Rotations64& local) {
  Rotations turned;
  for (size_t j = 0; j < kJointCount; ++j) turned[j] = local[j].cast<float>();
  const PosedSkeleton truth{global_rotations(turned), joints.cast<float>()};
  LabelledPoints cloud{points.cast<float>(), {}};
  cloud.parts = nearest_parts(cloud.points, truth.joints);
  Rng same(case_seed(plan.name));
  kOcclusions[plan.occlusion].put(cloud, truth, same);
  return cloud.points.cast<double>();
}

/// Elbows, shoulders, knees and both hips, one after the other bent by 120 degrees and straightened, arms
/// hanging otherwise.
ExactMotion bending_motion() {
  constexpr int kMoves = 5;
  const double far = 2 * M_PI / 3, hang = 7 * M_PI / 18;
  ExactMotion motion;
  motion.root.assign(size_t{kMoves} * kBendFrames, Vector3d::Zero());
  Rotations64 standing;
  standing.fill(Matrix3d::Identity());
  standing[LeftShoulder] = exact_rotation({0, 0, -hang});
  standing[RightShoulder] = exact_rotation({0, 0, hang});
  motion.local.assign(motion.root.size(), standing);
  for (int t = 0; t < kMoves * kBendFrames; ++t) {
    const double sine = std::sin(M_PI * (t % kBendFrames) / kBendFrames), bend = far * sine * sine;
    Rotations64& local = motion.local[t];
    const int move = t / kBendFrames;
    for (const bool left : {true, false}) {
      const double side = left ? 1 : -1;
      Matrix3d& shoulder = local[left ? LeftShoulder : RightShoulder];
      if (move == 0) local[left ? LeftElbow : RightElbow] = exact_rotation({0, -side * bend, 0});
      if (move == 1) shoulder = exact_rotation({-bend, 0, 0}) * shoulder;
      if (move == 2) local[left ? LeftKnee : RightKnee] = exact_rotation({bend, 0, 0});
      if (move != (left ? 3 : 4)) continue;
      local[left ? LeftHip : RightHip] = exact_rotation({-bend, 0, 0});
      local[left ? LeftKnee : RightKnee] = exact_rotation({0.75 * bend, 0, 0});
    }
  }
  return motion;
}

/// The clip of the case, turned to a random heading.
ExactMotion turned_motion(Workshop& shop, const CasePlan& plan) {
  const std::string& suite = shop.options.suite;
  const int frames = has_joints_only(suite) ? kExtractionFrames
                     : suite == "hands"     ? std::min(shop.options.frames, kHandFrames)
                                            : shop.options.frames;
  ExactMotion motion = shop.options.suite == "bends"
                           ? bending_motion()
                           : read_exact_motion(plan.motion.path, plan.motion.start, frames);
  const Matrix3d turn = exact_rotation({0, shop.random.uniform(-M_PI, M_PI), 0});
  for (Rotations64& local : motion.local) local[Pelvis] = turn * local[Pelvis];
  for (Vector3d& root : motion.root) root = turn * root;
  return motion;
}

/// A pose of the file but its first, or any.
HandAngles drawn_hand(const HandPoses& poses, NumpyRandom& random) {
  if (random.random() < 0.7) return poses.poses().at(random.integers(1, ssize(poses.poses())));
  return poses.sample({[&] { return random.random(); }, [&] { return random.normal(); },
                       [&](int count) { return static_cast<int>(random.integers(0, count)); }});
}

/// T-pose vertices of each frame: both hands go from one random pose to another and back.
std::vector<Points64> moving_fingers(Workshop& shop, const ExactPerson& person, size_t frames) {
  const HandVertices hands = shop.hands->vertices_of(shop.body.weights, person.weights);
  std::array<std::array<HandAngles, 2>, 2> ends;  // of each side
  for (auto& side : ends)
    for (HandAngles& end : side) end = drawn_hand(*shop.hands, shop.random);
  std::vector<Points64> vertices;
  for (size_t t = 0; t < frames; ++t) {
    const auto share =
        static_cast<float>(0.5 - 0.5 * std::cos(2 * M_PI * static_cast<double>(t) / kHandPeriod));
    std::array<HandAngles, 2> now;
    for (size_t side = 0; side < 2; ++side)
      now[side] = ends[side][0] + share * (ends[side][1] - ends[side][0]);
    const Points bent = shop.hands->apply(person.vertices.cast<float>(), hands, now);
    Points64& all = vertices.emplace_back(person.vertices);  // exact but for the hands
    for (const auto& rows : hands.rows)
      for (const int row : rows) all.row(row) = bent.row(row).cast<double>();
  }
  return vertices;
}

/// What the source's hands touch, and how far its arms are in its own body.
void add_touching(const ExactPerson& source, const Performance& shown, Npz& truth) {
  const HandContact contact(source.vertices.cast<float>(), source.faces, source.joints.cast<float>());
  NpyArray gaps, buried;
  for (const Points64& vertices : shown.vertices) {
    const Points posed = vertices.cast<float>();
    for (const auto& hand : contact.gaps(posed))
      gaps.values.insert(gaps.values.end(), hand.begin(), hand.end());
    buried.values.push_back(static_cast<float>(contact.buried(posed)));
  }
  gaps.shape = {static_cast<int64_t>(shown.vertices.size()), 2, kTouchedParts};
  buried.shape = {static_cast<int64_t>(shown.vertices.size())};
  truth["source_gaps"] = std::move(gaps);
  truth["source_buried"] = std::move(buried);
}

/// The target's file and truth: the source's path from where it starts, scaled by leg length.
void add_target(const Workshop& shop, const CasePlan& plan, const Performance& shown, double source_leg,
                ExactMotion motion, const fs::path& folder, Npz& truth) {
  const ExactPerson target =
      plan.target ? shop.shapes.shaped(*plan.target) : exact_person(read_dressed_body(plan.dressed_target));
  const Vector3d start(shown.joints[0](Pelvis, 0), 0, shown.joints[0](Pelvis, 2));
  const double scale = target.leg() / source_leg;
  for (size_t t = 0; t < motion.root.size(); ++t)
    motion.root[t] = (Vector3d(shown.joints[t].row(Pelvis)) - start) * scale + start;
  const Performance performance = perform(target, motion, 1);
  write_target((folder / "target.obj").string(), target);
  truth["vertices"] = frames_array(performance.vertices, {target.vertices.rows(), 3});
  truth["joints"] = frames_array(performance.joints, {kJointCount, 3});
  truth["target_joints"] = frames_array(std::vector<Joints64>{target.joints}, {kJointCount, 3});
  truth["target_joints"].shape = {kJointCount, 3};
}

void make_case(Workshop& shop, const CasePlan& plan) {
  const fs::path folder = fs::path(shop.options.out) / plan.name;
  make_scan_folder(folder / "source");
  const ExactMotion motion = turned_motion(shop, plan);
  const ExactPerson source = plan.dressed_source.empty()
                                 ? shop.shapes.shaped(plan.source)
                                 : exact_person(read_dressed_body(plan.dressed_source));
  std::vector<Points64> fingers;
  if (shop.hands) fingers = moving_fingers(shop, source, motion.local.size());
  const Performance shown = perform(source, fingers, motion, source.leg() / shop.template_leg);
  Npz truth{{"rotations", rotations_array(motion.local)},
            {"source_joints", frames_array(shown.joints, {kJointCount, 3})}};
  const bool performed = plan.target || !plan.dressed_target.empty();
  if (performed) {
    add_target(shop, plan, shown, source.leg(), motion, folder, truth);
    add_touching(source, shown, truth);
  }
  for (size_t t = 0; t < shown.vertices.size(); ++t) {
    const auto count = static_cast<int64_t>(shop.options.points * shop.random.uniform(0.8, 1.2));
    const auto scan = shop.options.suite == "captured" ? captured : points_on_surface;
    Points64 points = scan(shop.random, shown.vertices[t], source.faces, count);
    if (shop.options.suite == "occluded") points = occluded(plan, points, shown.joints[t], motion.local[t]);
    const Points64 shuffled = picked_rows(points, shop.random.permutation(points.rows()));
    write_scan(folder / "source", t, shuffled.cast<float>());
  }
  write_npz((folder / "truth.npz").string(), truth);
  Json json = {{"fps", 30}, {"source", "source"}};
  if (performed) json["target"] = "target.obj";
  json["truth"] = "truth.npz";
  json["tags"] = {shop.options.suite, plan.motion.tag};
  if (shop.options.suite == "occluded") json["tags"].push_back(kOcclusions[plan.occlusion].name);
  write_json((folder / "case.json").string(), json);
}

/// The split's motions; where it names none, the beginning of each clip of its subjects.
std::vector<EvaluatedMotion> motions_of(const DataSplit& split) {
  if (!split.motions.empty()) return split.motions;
  std::vector<EvaluatedMotion> motions;
  for (const std::string& folder : split.motion_folders)
    for (const auto& entry : fs::directory_iterator(folder))
      if (file_suffix(entry.path().string()) == ".npz")
        motions.push_back({entry.path().string(), 0, entry.path().stem().string()});
  std::sort(motions.begin(), motions.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return motions;
}

}  // namespace

int make_suite(const SuiteOptions& options, const std::function<void(const std::string&)>& done) {
  if (is_creature_suite(options.suite) && options.data.empty()) return make_creature_suite(options, {}, done);
  if (options.suite == "style") return make_style_suite(options, done);
  if (is_flat_suite(options.suite)) return make_flat_suite(options, done);
  if (is_lift_suite(options.suite)) return make_lift_suite(options, done);
  DataSplit split = read_split(options.data, options.split);
  if (options.suite == "inbetween" || options.suite == "predict")
    return make_inbetween_suite(options, split, done);
  if (options.suite == "sparse") return make_sparse_suite(options, split, done);
  split.motions = motions_of(split);
  US_CHECK(!split.motions.empty(), options.data, ": the split \"", options.split, "\" names no motion");
  if (is_creature_suite(options.suite)) return make_creature_suite(options, std::move(split), done);
  US_CHECK(options.points >= 100, "a scan of ", options.points, " points shows nobody: at least 100");
  if (is_capture_suite(options.suite)) return make_capture_suite(options, std::move(split), done);
  const bool dressed = options.suite == "clothed" || options.suite == "captured";
  US_CHECK(!dressed || !split.clothed.empty(), options.data, ": the split \"", options.split,
           "\" has no clothed people, but the suite ", options.suite, " needs them");
  Workshop shop(options, std::move(split));
  std::vector<CasePlan> plans = has_joints_only(options.suite) ? extraction_plans(shop)
                                : options.suite == "bends"     ? bend_plans(shop)
                                                               : performance_plans(shop);
  if (options.cases > 0 && plans.size() > static_cast<size_t>(options.cases)) plans.resize(options.cases);
  for (const CasePlan& plan : plans) {
    check_interrupt("before case " + plan.name);
    make_case(shop, plan);
    done(plan.name);
  }
  return plans.size();
}

}  // namespace understudy::app
