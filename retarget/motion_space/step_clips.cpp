#include "retarget/motion_space/step_clips.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/motion_space/step_form.hpp"

namespace understudy {
namespace {

/// Of the file's `joint_offsets` [22, 3], each from its parent.
Joints performer_of(const Npz& npz, const std::string& path, const Joints& mean) {
  const auto found = npz.find("joint_offsets");
  if (found == npz.end()) return mean;
  const RowMatrix offsets = found->second.matrix(3, path + ": joint_offsets");
  US_CHECK(offsets.rows() == kJointCount && offsets.allFinite(), path, ": joint_offsets are not of ",
           kJointCount, " joints");
  Joints joints = Joints::Zero();
  for (int j = 1; j < kJointCount; ++j) joints.row(j) = joints.row(kParents[j]) + offsets.row(j);
  US_CHECK(leg_length(joints) > 0.1f, path, ": joint_offsets have legs of ", leg_length(joints), " m");
  return joints;
}

StepClip step_clip(const std::string& path, const Joints& mean) {
  const Npz npz = read_npz(path);
  StepClip made;
  made.clip = read_clip(path);
  made.rest = performer_of(npz, path, mean);
  const auto info = npz.find("info");
  if (info != npz.end())
    for (const std::string& label : labels_of_info(info->second.text))
      made.walks = made.walks || label == "walk" || label == "run";
  made.steps = find_steps(made.clip.motion);
  return made;
}

}  // namespace

std::vector<StepClip> read_step_clips(const DataSplit& split, const Joints& mean) {
  std::vector<StepClip> clips;
  for (const std::string& folder : split.motion_folders)
    for (const std::string& path : clip_files(folder)) {
      StepClip clip = step_clip(path, mean);
      if (!clip.steps.empty()) clips.push_back(std::move(clip));
    }
  US_CHECK(!clips.empty(), "nobody steps in the clips of ",
           split.motion_folders.empty() ? "no folder" : split.motion_folders.front());
  return clips;
}

ShapedBody mean_body(const DataSplit& split) {
  ShapedBody body = read_smpl_body(split.body).shaped(Eigen::VectorXf::Zero(1));
  const Eigen::RowVector3f pelvis = body.joints.row(Pelvis);
  body.joints.rowwise() -= pelvis;
  body.vertices.rowwise() -= pelvis;
  return body;
}

TimedPoses performed_step(const StepClip& clip, const Step& step, float mean_leg_m) {
  TimedPoses movement = movement_of(clip.clip.motion, step.first, step.last);
  for (Pose& pose : movement.poses) pose.root *= leg_length(clip.rest) / mean_leg_m;
  return movement;
}

RowMatrix step_rows(const std::vector<StepClip>& clips, float mean_leg_m) {
  std::vector<StepNumbers> all;
  for (const StepClip& clip : clips)
    for (const Step& step : clip.steps) {
      TimedPoses movement = performed_step(clip, step, mean_leg_m);
      all.push_back(step_numbers(movement, clip.rest));
      for (Pose& pose : movement.poses) pose = mirrored(pose);
      all.push_back(step_numbers(movement, clip.rest));
    }
  RowMatrix rows(ssize(all), kStepNumbers);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = all[static_cast<size_t>(i)];
  return rows;
}

}  // namespace understudy
