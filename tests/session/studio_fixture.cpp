#include "tests/session/studio_fixture.hpp"

#include <unistd.h>

#include <algorithm>

#include "retarget/body/builtin_motion.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/skeleton/curve_doubt.hpp"
#include "retarget/style/load_style.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"
#include "tests/session/crash_trace.hpp"
#include "tests/support/flat_track.hpp"

namespace understudy::app {
namespace {

/// Knows where the joints of any target in T-pose are: a mean human's.
class RestExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    Extraction e;
    const Joints& human = human_rest();
    const Vec3 middle = 0.5f * (human.colwise().maxCoeff() + human.colwise().minCoeff()).transpose();
    const Vec3 centre =
        0.5f * (scan.vertices.colwise().maxCoeff() + scan.vertices.colwise().minCoeff()).transpose();
    e.joints = human.rowwise() + (centre - middle).transpose();
    return e;
  }
  std::string name() const override { return "rest"; }
};

/// Extracts the joints hidden in a scan and counts how often it was asked; in targets, and in points drawn
/// from them, it sees a person in T-pose.
class CountingExtractor final : public SkeletonExtractor {
 public:
  explicit CountingExtractor(std::shared_ptr<std::atomic<int>> count) : count_(std::move(count)) {}
  Extraction extract(const Mesh& scan) override {
    if (!scan.is_cloud() || scan.vertices.rows() > 5000) return rest_.extract(scan);
    ++*count_;
    return telltale_.extract(scan);
  }
  std::string name() const override { return "counting"; }

 private:
  std::shared_ptr<std::atomic<int>> count_;
  fixtures::TellTaleExtractor telltale_;
  RestExtractor rest_;
};

/// A dance of `frames` scans as an array; the joints are each frame's last points.
void write_scans(const std::string& path, int frames) {
  const fixtures::PointBody body(human_rest());
  NpyArray points;
  for (int t = 0; t < frames; ++t) {
    const Mesh scan = fixtures::scan_of(body, human_rest(), fixtures::dance(0.1f * static_cast<float>(t)));
    points.shape = {frames, scan.vertices.rows(), 3};
    points.values.insert(points.values.end(), scan.vertices.data(),
                         scan.vertices.data() + scan.vertices.size());
  }
  write_npz(path, {{"points", points}});
}

void write_target(const std::string& path) {
  const fixtures::PointBody body(human_rest());
  std::ofstream file(path);
  for (Eigen::Index v = 0; v < body.mesh.vertices.rows(); ++v)
    file << "v " << body.mesh.vertices.row(v) << '\n';
  for (Eigen::Index v = 0; v + 2 < body.mesh.vertices.rows(); v += 3)
    file << "f " << v + 1 << ' ' << v + 2 << ' ' << v + 3 << '\n';
}

}  // namespace

void NearestDeformer::bind(const Points& rest, const Joints& joints) {
  rest_ = rest;
  joints_ = joints;
  weights_ = RowMatrix::Zero(rest.rows(), kJointCount);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    Eigen::Index nearest = 0;
    (joints.rowwise() - rest.row(v)).rowwise().squaredNorm().minCoeff(&nearest);
    weights_(v, nearest) = 1;
  }
}

std::shared_ptr<Deformer> NearestDeformer::with_weights(RowMatrix weights) const {
  auto other = std::make_shared<NearestDeformer>(*this);
  other->weights_ = std::move(weights);
  return other;
}

Points NearestDeformer::deform(const Pose& pose) const {
  return linear_blend_skinning(rest_, weights_, joints_, forward_kinematics(joints_, pose));
}

Points NearestDeformer::offsets(const Pose&) const {
  return Points::Zero(rest_.rows(), 3);
}

Completion LiftedSpace::complete(const KnownMotion& question) {
  Completion made{question.motion, curve_doubt(question.known, question.motion, question.rest)};
  fill_curves(question.known, 0, static_cast<int>(question.known.size()) - 1, made.motion);
  for (size_t t = 0; t < question.known.size(); ++t)
    if (question.known[t] != all_parts(true))
      made.motion.poses[t].root.y() += kLift_m + kAlternativeLift_m * static_cast<float>(question.variation);
  return made;
}

bool same_poses(const Motion& a, const Motion& b) {
  const auto same = [](const Pose& one, const Pose& other) {
    return one.root == other.root && one.local == other.local;
  };
  return std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(), same);
}

void StudioTest::SetUp() {
  tell_where_it_crashes();
  folder_ = fs::temp_directory_path() / ("understudy_studio_" + std::to_string(::getpid()) + "_" +
                                         ::testing::UnitTest::GetInstance()->current_test_info()->name());
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  before_ = fs::current_path();
  fs::current_path(folder_);  // whatever is written without a folder lands here
  write_scans(path("scan.npz"), kFrames);
  write_target(path("target.obj"));
}

void StudioTest::TearDown() {
  fs::current_path(before_);
  fs::remove_all(folder_);
}

StudioServices StudioTest::services() {
  StudioServices services;
  services.networks = [count = extractions_](const Method& method, const NetworkParts& parts) {
    Networks networks;
    if (parts.extractor) networks.extractor = std::make_shared<CountingExtractor>(count);
    if (parts.rest_extractor) networks.rest_extractor = std::make_shared<RestExtractor>();
    if (parts.transfer) networks.transfer = std::make_shared<CopyTransfer>(method.engine != "paper");
    if (parts.deformer) networks.deformer = std::make_shared<NearestDeformer>();
    if (parts.style) networks.style = load_style(method.style);
    return networks;
  };
  services.motion_space = [] { return std::make_shared<LiftedSpace>(); };
  services.lifter = [] { return std::make_unique<StandingLifter>(human_rest()); };
  services.lengths = [] { return std::make_shared<const SeenLengths>(); };
  services.weights = [] { return std::string("stand-ins:00000000"); };
  services.autosave_folder = path("state");
  return services;
}

std::string StudioTest::folder_without(const std::set<int>& missing, const std::string& name) {
  fs::create_directories(path(name));
  ScanSource source(path("scan.npz"));
  for (int t = 0; const auto frame = source.next(); ++t) {
    if (missing.count(t) > 0) continue;
    std::ofstream file(path(name) + "/f" + std::to_string(t) + ".xyz");
    file << frame->mesh.vertices << '\n';
  }
  return path(name);
}

void StudioTest::open_both(Studio& studio) {
  studio.run("open", {path("scan.npz")});
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
}

void StudioTest::open_walk(Studio& studio) {
  const Motion walk = builtin_motion("walk", human_rest());
  BvhWriter writer(path("walk.bvh"), human_rest(), walk.fps);
  for (const Pose& pose : walk.poses) writer.push(pose);
  writer.finish();
  studio.run("open", {path("walk.bvh")});
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
}

}  // namespace understudy::app
