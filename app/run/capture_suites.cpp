#include "app/run/capture_suites.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/run/actor.hpp"
#include "app/run/case_writer.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/scene_cases.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/body/costume.hpp"
#include "retarget/body/depth_cameras.hpp"
#include "retarget/body/joint_sight.hpp"
#include "retarget/body/partial_view.hpp"
#include "retarget/body/seated_pose.hpp"
#include "retarget/body/surroundings.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 30, kOfEachKind = 4;
constexpr float kScanNoise = 0.003f;  // metres, of partial scans

/// One person of a case as a scan shows them, frame after frame.
struct OnePersonTruth {
  std::vector<Joints> joints;
  std::vector<Rotations> local;
  std::vector<SeenJoints> seen;

  void add(const Actor& actor, size_t frame, const SeenJoints& shown) {
    joints.push_back(actor.skeleton(frame).joints);
    local.push_back(actor.poses()[frame].local);
    seen.push_back(shown);
  }
  Npz arrays() const {
    return {{"rotations", rotations_array(local)},
            {"source_joints", frames_array(joints, {kJointCount, 3})},
            {"source_seen", frames_array(seen, {kJointCount})}};
  }
};

/// What all cases of a suite share.
struct CaptureSuite {
  const SuiteOptions& options;
  Cast cast;
  int frames() const { return std::min(options.frames, kFrames); }
};

struct NewCase {
  fs::path path;
  std::vector<std::string> tags;

  void finish(const OnePersonTruth& truth) const {
    write_npz((path / "truth.npz").string(), truth.arrays());
    write_json((path / "case.json").string(),
               {{"fps", 30}, {"source", "source"}, {"truth", "truth.npz"}, {"tags", tags}});
  }
};

/// About `count` of the points, in random order.
void thin(LabelledPoints& cloud, float count, Rng& rng) {
  const float share = count / static_cast<float>(cloud.points.rows());
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i)
    if (share >= 1 || rng.chance(share)) kept.push_back(i);
  for (size_t i = 0; i + 1 < kept.size(); ++i)
    std::swap(kept[i], kept[i + rng.below(static_cast<int>(kept.size() - i))]);
  keep_rows(cloud, kept);
}

/// Half of somebody, a way a kind.
struct PartialKind {
  const char* name;
  void (*hide)(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng);
  bool is_seated = false;
};
constexpr std::array<PartialKind, 4> kPartialKinds = {
    {{"hips", [](LabelledPoints& cloud, const PosedSkeleton& first,
                 Rng& rng) { cut_below(cloud, first, BodyCut::Hips, rng); }},
     {"knees", [](LabelledPoints& cloud, const PosedSkeleton& first,
                  Rng& rng) { cut_below(cloud, first, BodyCut::Knees, rng); }},
     {"chest", [](LabelledPoints& cloud, const PosedSkeleton& first,
                  Rng& rng) { cut_below(cloud, first, BodyCut::Chest, rng); }},
     {"desk", put_behind_desk, true}}};

/// Number `which` of a kind: the odd ones are seen by one camera, and sit on a chair that is seen, too.
void make_partial_case(const CaptureSuite& suite, const PartialKind& kind, size_t which,
                       const NewCase& folder) {
  const Rng same(case_seed(folder.path.filename().string(), suite.options.seed));
  Rng rng(Rng(same).next());
  const size_t number = which + kOfEachKind * (&kind - kPartialKinds.data());
  Actor actor = suite.cast.actor(number, number + which, suite.frames(), rng);
  std::vector<Pose> poses = actor.poses();
  if (kind.is_seated) {
    sit_down(poses, rng);
    for (Pose& pose : poses) pose.root = poses[0].root;
    actor.perform(std::move(poses));
  }
  actor.move(rng.uniform(-kPi, kPi), Vec3::Zero());
  const PosedSkeleton first = actor.skeleton(0);
  const bool is_odd = which % 2 == 1;
  OnePersonTruth truth;
  for (size_t t = 0; t < actor.frames(); ++t) {
    LabelledPoints cloud = actor.surface(t, 4 * suite.options.points, rng);
    const PosedSkeleton posed = actor.skeleton(t);
    const PerJoint whole = surface_about_joints(cloud, posed);
    Rng hides(same), side(Rng(same).next() + 1), chair(Rng(same).next() + 2);
    if (kind.is_seated && is_odd) add_chair_below(cloud, first, {chair, rng});
    kind.hide(cloud, first, hides);
    if (is_odd && !kind.is_seated) see_from_one_side(cloud, posed, side);
    thin(cloud, static_cast<float>(suite.options.points) * rng.uniform(0.8f, 1.2f), rng);
    for (float& x : cloud.points.reshaped()) x += kScanNoise * rng.normal();
    truth.add(actor, t, joint_sight(whole, cloud, posed).seen);
    write_scan(folder.path / "source", t, cloud.points);
  }
  folder.finish(truth);
}

struct SensorKind {
  const char* name;
  int cameras;
};
constexpr std::array<SensorKind, 3> kSensorKinds = {{{"one", 1}, {"three", 3}, {"ten", 10}}};
constexpr std::array<float, kOfEachKind> kSensorPoints = {5000, 15000, 40000, 100000};

/// The ground about a place, as dense as 0.4 times a person's skin.
void add_floor(SeenSurface& surface, const Vec3& middle, float radius, Rng& rng) {
  const float density =
      0.4f * static_cast<float>(surface.now.rows()) / 1.9f;  // skin: about 1.9 square metres
  const auto count = static_cast<Eigen::Index>(density * kPi * radius * radius);
  const Eigen::Index before = surface.now.rows();
  surface.now.conservativeResize(before + count, 3);
  for (Eigen::Index i = before; i < surface.now.rows(); ++i) {
    const float angle = rng.uniform(-kPi, kPi), away = radius * std::sqrt(rng.uniform());
    surface.now.row(i) << middle.x() + away * std::sin(angle), 0, middle.z() + away * std::cos(angle);
  }
  surface.beside.conservativeResize(before + count, 3);
  surface.beside.bottomRows(count) = surface.now.bottomRows(count);
  surface.returned.resize(before + count, 1.0f);
}

/// Depth cameras about somebody, with the ground that they see.
void make_sensor_case(const CaptureSuite& suite, const SensorKind& kind, size_t which,
                      const NewCase& folder) {
  Rng rng(case_seed(folder.path.filename().string(), suite.options.seed));
  const size_t number = which + kOfEachKind * (&kind - kSensorKinds.data());
  Actor actor = suite.cast.actor(number, number + which, suite.frames(), rng);
  actor.move(rng.uniform(-kPi, kPi), Vec3::Zero());
  const PosedSkeleton middle = actor.skeleton(actor.frames() / 2);
  const Vec3 at = middle.joints.row(Spine1).transpose();
  const DepthRig rig = random_depth_rig({kind.cameras, at, 1.5f, 4.0f}, rng);
  const float radius = rng.uniform(1.2f, 2.2f), wanted = kSensorPoints[which];
  float raw = 1.2f * wanted;  // points on the skin; soon so many that enough are seen
  OnePersonTruth truth;
  for (size_t t = 0; t < actor.frames(); ++t) {
    const LabelledPoints person = actor.surface(t, static_cast<int>(raw), rng);
    const PosedSkeleton posed = actor.skeleton(t);
    SeenSurface surface = surface_to_see(person, rig.dark, posed, actor.beside(t));
    add_floor(surface, at, radius, rng);
    LabelledPoints seen;
    std::vector<Vec3> places;
    for (const DepthReading& reading : depth_readings(surface, rig.cameras, rng)) {
      places.push_back(reading.place);
      const bool is_body = reading.row < person.points.rows() && !reading.flies();
      seen.parts.push_back(is_body ? person.parts[reading.row] : kNoBody);
    }
    seen.points = rows_of(places);
    raw *= std::clamp(1.3f * wanted / static_cast<float>(places.size()), 0.25f, 4.0f);
    thin(seen, wanted * rng.uniform(0.8f, 1.2f), rng);
    truth.add(actor, t, joint_sight(surface_about_joints(person, posed), seen, posed).seen);
    write_scan(folder.path / "source", t, seen.points);
  }
  folder.finish(truth);
}

/// A case and what makes it.
struct CapturePlan {
  std::string name, kind;
  std::function<void(const NewCase&)> make;
};

std::vector<CapturePlan> capture_plans(const CaptureSuite& suite) {
  std::vector<CapturePlan> plans;
  const auto add = [&](const auto& kinds, auto make) {
    for (size_t which = 0; which < kOfEachKind; ++which)
      for (const auto& kind : kinds)
        plans.push_back({kind.name + std::to_string(which), kind.name,
                         [&suite, &kind, which, make](const NewCase& to) { make(suite, kind, which, to); }});
  };
  if (suite.options.suite == "partial") add(kPartialKinds, make_partial_case);
  if (suite.options.suite == "sensors") add(kSensorKinds, make_sensor_case);
  return plans;
}

}  // namespace

bool is_capture_suite(const std::string& suite) {
  return suite == "partial" || suite == "sensors" || suite == "scenes";
}

int make_capture_suite(const SuiteOptions& options, DataSplit split,
                       const std::function<void(const std::string&)>& done) {
  const CaptureSuite suite{options, Cast(std::move(split), options.body)};
  if (options.suite == "scenes") return make_scene_cases(options, suite.cast, done);
  std::vector<CapturePlan> plans = capture_plans(suite);
  if (options.cases > 0 && plans.size() > static_cast<size_t>(options.cases)) plans.resize(options.cases);
  for (const CapturePlan& plan : plans) {
    check_interrupt("before case " + plan.name);
    const NewCase folder{fs::path(options.out) / plan.name, {options.suite, plan.kind}};
    make_scan_folder(folder.path / "source");
    plan.make(folder);
    done(plan.name);
  }
  return static_cast<int>(plans.size());
}

}  // namespace understudy::app
