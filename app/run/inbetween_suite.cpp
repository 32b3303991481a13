#include "app/run/inbetween_suite.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <filesystem>

#include "app/run/case_writer.hpp"
#include "app/run/gap_plan.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/math/percentile.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr double kTravels = 0.6;  // m/s
constexpr int kEnds = 10, kEvery = 15, kWalkEnds = 5, kWalkEvery = 3;
constexpr int kFloorFrames = 5;  // every so many are looked at for the floor where no surface is kept

bool is_walk(const std::vector<std::string>& labels) {
  return std::any_of(labels.begin(), labels.end(),
                     [](const std::string& label) { return label == "walk" || label == "run"; });
}

/// Where there are scans the missing frames are those of windows that follow one another.
GapPlan plan_of(const SuiteOptions& options, const Clip& clip) {
  GapPlan plan;
  const int all = static_cast<int>(ssize(clip.motion.poses));
  plan.frames = options.points > 0 ? std::min(all, options.frames) : all;
  plan.gap = options.gap;
  plan.ends = options.walks ? kWalkEnds : kEnds;
  plan.every = options.points > 0 ? plan.gap + plan.ends : options.walks ? kWalkEvery : kEvery;
  for (int t = 0; t < plan.frames; ++t)
    if (!std::binary_search(clip.good.begin(), clip.good.end(), t)) plan.bad_frames.push_back(t);
  return plan;
}

struct InbetweenCase {
  std::string name, path;
  std::vector<std::string> tags;
  GapPlan plan;
};

std::vector<InbetweenCase> cases_of(const SuiteOptions& options, const DataSplit& split) {
  std::vector<InbetweenCase> cases;
  for (const std::string& folder : split.motion_folders)
    for (const std::string& path : clip_files(folder)) {
      const std::vector<std::string> labels = clip_labels(path);
      if (options.walks && !is_walk(labels)) continue;
      const Clip clip = read_clip(path);
      US_CHECK(std::lround(clip.motion.fps) == 30, path, ": at ", clip.motion.fps, " frames/s, not 30");
      InbetweenCase made{fs::path(path).stem().string(), path, inbetween_tags(clip.motion, labels),
                         plan_of(options, clip)};
      if (!window_starts(made.plan).empty()) cases.push_back(std::move(made));
    }
  US_CHECK(!cases.empty(), options.data, ": no ", options.walks ? "walk or run" : "clip", " of the split \"",
           options.split, "\" has a gap of ", options.gap, " frames with known ones beside it");
  return cases;
}

/// The motion on the person, its soles on the floor; vertices where scans are to be drawn.
Performance performed(const ExactPerson& person, const ExactMotion& motion, bool with_vertices) {
  if (with_vertices) return perform(person, motion, 1);
  ExactMotion few;
  for (size_t t = 0; t < motion.local.size(); t += kFloorFrames) {
    few.local.push_back(motion.local[t]);
    few.root.push_back(motion.root[t]);
  }
  const double lift = perform(person, few, 1).joints[0](Pelvis, 1) - few.root[0].y();
  Performance result;
  const Joints rest = person.joints.cast<float>();
  for (size_t t = 0; t < motion.local.size(); ++t) {
    Pose pose;
    for (int j = 0; j < kJointCount; ++j) pose.local[j] = motion.local[t][j].cast<float>();
    pose.root = (motion.root[t] + Eigen::Vector3d(0, lift, 0)).cast<float>();
    result.joints.push_back(forward_kinematics(rest, pose).joints.cast<double>());
  }
  return result;
}

Json case_json(const InbetweenCase& made, bool with_scans) {
  Json json = {{"fps", 30}};
  if (with_scans) json["source"] = "source", json["target"] = "target.obj";
  json["truth"] = "truth.npz";
  json["frames"] = made.plan.frames;
  json["gap"] = made.plan.gap;
  json["ends"] = made.plan.ends;
  json["every"] = made.plan.every;
  if (!made.plan.bad_frames.empty()) json["bad_frames"] = made.plan.bad_frames;
  json["tags"] = made.tags;
  return json;
}

void write_scans(const SuiteOptions& options, const InbetweenCase& made, const ExactPerson& person,
                 const Performance& shown, const fs::path& folder) {
  make_scan_folder(folder / "source");
  NumpyRandom random(static_cast<uint32_t>(case_seed(made.name, options.seed)));
  const std::vector<bool> known = known_frames(made.plan);
  for (size_t t = 0; t < known.size(); ++t) {
    if (!known[t]) continue;
    const auto count = static_cast<int64_t>(options.points * random.uniform(0.8, 1.2));
    write_scan(folder / "source", t,
               points_on_surface(random, shown.vertices[t], person.faces, count).cast<float>());
  }
}

void make_case(const SuiteOptions& options, const ExactPerson& person, const InbetweenCase& made) {
  const fs::path folder = fs::path(options.out) / made.name;
  const bool with_scans = options.points > 0;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const ExactMotion motion = read_exact_motion(made.path, 0, made.plan.frames);
  const Performance shown = performed(person, motion, with_scans);
  Npz truth{{"rotations", rotations_array(motion.local)},
            {"joints", frames_array(shown.joints, {kJointCount, 3})},
            {"source_joints", frames_array(shown.joints, {kJointCount, 3})},
            {"target_joints", frames_array(std::vector<Joints64>{person.joints}, {kJointCount, 3})}};
  truth["target_joints"].shape = {kJointCount, 3};
  if (with_scans) {
    truth["vertices"] = frames_array(shown.vertices, {person.vertices.rows(), 3});
    write_target((folder / "target.obj").string(), person);
    write_scans(options, made, person, shown, folder);
  }
  write_npz((folder / "truth.npz").string(), truth);
  write_json((folder / "case.json").string(), case_json(made, with_scans));
}

}  // namespace

std::vector<std::string> inbetween_tags(const Motion& motion, const std::vector<std::string>& labels) {
  std::vector<std::string> tags = {"inbetween"};
  std::vector<double> speeds;
  for (size_t t = 1; t < motion.poses.size(); ++t) {
    const Vec3 way = motion.poses[t].root - motion.poses[t - 1].root;
    speeds.push_back(static_cast<double>(std::hypot(way.x(), way.z()) * motion.fps));
  }
  if (is_walk(labels) || (!speeds.empty() && percentile(speeds, 50) > kTravels)) tags.push_back("travels");
  tags.insert(tags.end(), labels.begin(), labels.end());
  return tags;
}

int make_inbetween_suite(const SuiteOptions& options, const DataSplit& split,
                         const std::function<void(const std::string& name)>& done) {
  US_CHECK(options.gap > 0, "the suite inbetween needs --gap, the frames that are not known");
  std::vector<InbetweenCase> cases = cases_of(options, split);
  if (options.cases > 0 && ssize(cases) > options.cases) cases.resize(static_cast<size_t>(options.cases));
  const Body body = read_smpl_body(options.body.empty() ? split.body : options.body);
  const ExactPerson person = ExactBody(body).shaped({});
  for (const InbetweenCase& made : cases) {
    check_interrupt("before case " + made.name);
    make_case(options, person, made);
    done(made.name);
  }
  return static_cast<int>(ssize(cases));
}

}  // namespace understudy::app
