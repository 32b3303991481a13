#include "app/run/gap_case_writer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/run/case_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/math/percentile.hpp"

namespace understudy::app {
namespace {

constexpr double kTravels = 0.6;  // m/s
constexpr int kFloorFrames = 5;   // every so many are looked at for the floor where no surface is kept
constexpr int kSkinPoints = 500;

void add_skin(const ExactPerson& person, Npz& truth) {
  const Points vertices = person.vertices.cast<float>();
  const int count = static_cast<int>(std::min<Eigen::Index>(kSkinPoints, vertices.rows()));
  NpyArray points, weights;
  points.shape = {count, 3}, weights.shape = {count, kJointCount};
  for (const int v : farthest_points(vertices, count)) {
    points.values.insert(points.values.end(), vertices.row(v).begin(), vertices.row(v).end());
    weights.values.insert(weights.values.end(), person.weights.row(v).begin(), person.weights.row(v).end());
  }
  truth["skin_points"] = std::move(points);
  truth["skin_weights"] = std::move(weights);
}

}  // namespace

std::string LabelledClip::name() const {
  return std::filesystem::path(path).stem().string();
}

void each_clip(const SuiteOptions& options, const DataSplit& split,
               const std::function<void(const LabelledClip& clip)>& visit) {
  for (const std::string& folder : split.motion_folders)
    for (const std::string& path : clip_files(folder)) {
      const std::vector<std::string> labels = clip_labels(path);
      if (options.walks && !is_walk(labels)) continue;
      const LabelledClip one{path, labels, read_clip(path)};
      const float fps = one.clip.motion.fps;
      US_CHECK(std::lround(fps) == 30, path, ": at ", fps, " frames/s, not 30");
      visit(one);
    }
}

bool is_walk(const std::vector<std::string>& labels) {
  return std::any_of(labels.begin(), labels.end(),
                     [](const std::string& label) { return label == "walk" || label == "run"; });
}

std::vector<std::string> gap_tags(const std::string& suite, const Motion& motion,
                                  const std::vector<std::string>& labels) {
  std::vector<std::string> tags = {suite};
  std::vector<double> speeds;
  for (size_t t = 1; t < motion.poses.size(); ++t) {
    const Vec3 way = motion.poses[t].root - motion.poses[t - 1].root;
    speeds.push_back(static_cast<double>(std::hypot(way.x(), way.z()) * motion.fps));
  }
  if (is_walk(labels) || (!speeds.empty() && percentile(speeds, 50) > kTravels)) tags.push_back("travels");
  tags.insert(tags.end(), labels.begin(), labels.end());
  return tags;
}

Performance grounded(const ExactPerson& person, const ExactMotion& motion, bool with_vertices) {
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

Npz gap_truth(const ExactPerson& person, const ExactMotion& motion, const Performance& shown) {
  Npz truth{{"rotations", rotations_array(motion.local)},
            {"joints", frames_array(shown.joints, {kJointCount, 3})},
            {"source_joints", frames_array(shown.joints, {kJointCount, 3})},
            {"target_joints", frames_array(std::vector<Joints64>{person.joints}, {kJointCount, 3})}};
  truth["target_joints"].shape = {kJointCount, 3};
  add_skin(person, truth);
  if (!shown.vertices.empty()) truth["vertices"] = frames_array(shown.vertices, {person.vertices.rows(), 3});
  return truth;
}

}  // namespace understudy::app
