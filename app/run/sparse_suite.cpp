#include "app/run/sparse_suite.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "app/run/case_writer.hpp"
#include "app/run/gap_case_writer.hpp"
#include "app/run/gap_plan.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/marker_places.hpp"
#include "retarget/formats/markers.hpp"
#include "retarget/motion_space/steps.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr int kStepFrames = 100;
constexpr int kNextPerson = 7;  // of the split, from case to case

struct SparseCase {
  std::string name, path;
  std::vector<std::string> tags;
  Step step;

  double fps() const { return 30.0 * (kStepFrames - 1) / (step.last - step.first); }
};

bool has_surface(const SuiteOptions& options) {
  return options.points > 0 || options.markers > 0;
}

std::vector<SparseCase> sparse_cases_of(const SuiteOptions& options, const DataSplit& split) {
  std::vector<SparseCase> cases;
  each_clip(options, split, [&](const LabelledClip& clip) {
    for (const Step& step : find_steps(clip.clip.motion))
      cases.push_back({clip.name() + printed("_%04d%c", step.first, step.left_first ? 'l' : 'r'), clip.path,
                       gap_tags(options.suite, clip.clip.motion, clip.labels), step});
  });
  US_CHECK(!cases.empty(), options.data, ": nobody steps in ", options.walks ? "a walk or run" : "a clip",
           " of the split \"", options.split, "\"");
  const int64_t all = ssize(cases), wanted = options.cases;
  if (wanted == 0 || wanted >= all) return cases;
  std::vector<SparseCase> some;
  for (int64_t i = 0; i < wanted; ++i) some.push_back(cases[i * all / wanted]);
  return some;
}

/// Somewhere between two frames.
Rotations64 mixed(const Rotations64& a, const Rotations64& b, double share) {
  Rotations64 between;
  for (int j = 0; j < kJointCount; ++j)
    between[j] =
        Eigen::Quaterniond(a[j]).slerp(share, Eigen::Quaterniond(b[j])).normalized().toRotationMatrix();
  return between;
}

/// So many frames evenly from the first to the last.
ExactMotion resampled(const ExactMotion& motion, int count) {
  const auto last = static_cast<double>(motion.local.size() - 1);
  ExactMotion result;
  for (int i = 0; i < count; ++i) {
    const double at = last * i / (count - 1);
    const size_t before = std::min(static_cast<size_t>(at), motion.local.size() - 2);
    const double share = at - static_cast<double>(before);
    result.local.push_back(mixed(motion.local[before], motion.local[before + 1], share));
    result.root.push_back((1 - share) * motion.root[before] + share * motion.root[before + 1]);
  }
  return result;
}

void write_times(const std::string& path, const std::vector<int>& known, double fps) {
  std::string text = "scan,seconds\n";
  for (const int t : known) text += printed("frame_%05d,%.9g\n", t, t / fps);
  write_file(path, text, /*synced=*/false);
}

/// Where the markers of the known frames are.
std::vector<MarkerFrame> markers_of(const ExactPerson& person, const Performance& shown,
                                    const std::vector<int>& known, double fps) {
  const std::vector<int> marked = marker_vertices(person.vertices.cast<float>(), person.joints.cast<float>());
  std::vector<MarkerFrame> frames;
  for (const int t : known) {
    MarkerFrame& frame = frames.emplace_back();
    frame.seconds = t / fps;
    for (int m = 0; m < kMarkerCount; ++m)
      frame.markers.push_back(
          {kMarkerPlaces[m].name, shown.vertices[t].row(marked[m]).transpose().cast<float>()});
  }
  return frames;
}

Json sparse_json(const SuiteOptions& options, const SparseCase& made, const std::vector<int>& known) {
  Json json = {{"fps", made.fps()}};
  if (options.points > 0) json["source"] = "source", json["times"] = "times.csv";
  if (options.markers > 0) json["markers"] = "markers.csv";
  if (has_surface(options)) json["target"] = "target.obj";
  json["truth"] = "truth.npz";
  json["frames"] = kStepFrames;
  json["known"] = known;
  json["tags"] = made.tags;
  return json;
}

void make_sparse_case(const SuiteOptions& options, const ExactPerson& person, double path_scale,
                      const SparseCase& made) {
  const fs::path folder = fs::path(options.out) / made.name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const int frames = made.step.last - made.step.first + 1;
  ExactMotion motion = resampled(read_exact_motion(made.path, made.step.first, frames), kStepFrames);
  for (Eigen::Vector3d& root : motion.root) root *= path_scale;
  const Performance shown = grounded(person, motion, has_surface(options));
  const std::vector<int> known = evenly_known(kStepFrames, options.known);
  if (has_surface(options)) write_target((folder / "target.obj").string(), person);
  if (options.points > 0) {
    make_scan_folder(folder / "source");
    NumpyRandom random(static_cast<uint32_t>(case_seed(made.name, options.seed)));
    for (const int t : known)
      write_scan(folder / "source", static_cast<size_t>(t),
                 points_on_surface(random, shown.vertices[t], person.faces, options.points).cast<float>());
    write_times((folder / "times.csv").string(), known, made.fps());
  }
  if (options.markers > 0)
    write_markers((folder / "markers.csv").string(), markers_of(person, shown, known, made.fps()));
  write_npz((folder / "truth.npz").string(), gap_truth(person, motion, shown));
  write_json((folder / "case.json").string(), sparse_json(options, made, known));
}

}  // namespace

int make_sparse_suite(const SuiteOptions& options, const DataSplit& split,
                      const std::function<void(const std::string& name)>& done) {
  US_CHECK(options.known > 0, "the suite sparse needs --known, the frames of 100 that are known");
  US_CHECK(options.markers == 0 || options.markers == kMarkerCount, "there are ", kMarkerCount,
           " markers, not ", options.markers);
  const std::vector<SparseCase> cases = sparse_cases_of(options, split);
  const Body body = read_smpl_body(options.body.empty() ? split.body : options.body);
  const ExactBody shapes(body);
  const ExactPerson usual = shapes.shaped({});
  const bool by_people = has_surface(options) && !split.betas.empty();
  for (size_t i = 0; i < cases.size(); ++i) {
    check_interrupt("before case " + cases[i].name);
    const ExactPerson person =
        by_people ? shapes.shaped(split.betas[i * kNextPerson % split.betas.size()]) : usual;
    make_sparse_case(options, person, person.leg() / usual.leg(), cases[i]);
    done(cases[i].name);
  }
  return static_cast<int>(ssize(cases));
}

}  // namespace understudy::app
