#include "app/run/styled_clip.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/run/retargeted_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/running_median.hpp"

namespace understudy::app {
namespace {

/// The frame of a body that is the source's own.
Pose own_pose(const PerformedFrame& frame, CopyTransfer& bones, float dt) {
  return {bones.push(frame.source, dt), frame.source.joints.row(Pelvis).transpose()};
}

}  // namespace

std::vector<Rotations> StyledClip::local() const {
  std::vector<Rotations> all;
  for (const Pose& pose : poses) all.push_back(pose.local);
  return all;
}

StyledClip styled_clip(const SourceOptions& options, const Networks& networks, const RetargetOptions& how,
                       const SourceTools& tools, const ClipStep& step) {
  Retargeter retargeter(networks, how);
  const auto source = open_source(options);
  RetargetedSource retargeted(*source, retargeter, options, tools);
  StyledClip clip;
  clip.fps = source->fps();
  CopyTransfer bones;
  bones.reset(human_rest());
  std::array<RunningMedian, kJointCount> lengths;
  std::optional<Vec3> before;
  while (const auto frame = retargeted.next()) {
    if (step) step(retargeted.frames(), source->count().value_or(0));
    if (frame->result.flagged && clip.poses.empty()) continue;
    clip.poses.push_back(frame->result.flagged
                             ? clip.poses.back()
                             : own_pose(frame->result, bones, static_cast<float>(1 / clip.fps)));
    if (frame->result.flagged) continue;
    const auto seen = bone_lengths(frame->result.source.joints);
    for (int j = 1; j < kJointCount; ++j) lengths[j].push(seen[j]);
    const Vec3 was = source_joints(frame->result).row(Pelvis).transpose(), is = clip.poses.back().root;
    if (before) clip.path_m += std::hypot(was.x() - before->x(), was.z() - before->z());
    before = was;
    clip.apart_m = std::hypot(is.x() - was.x(), is.z() - was.z());
  }
  retargeted.check_used();
  Eigen::Array<float, kJointCount, 1> usual = Eigen::Array<float, kJointCount, 1>::Zero();
  for (int j = 1; j < kJointCount; ++j) usual[j] = 0.5f * (lengths[j].value() + lengths[kMirror[j]].value());
  clip.rest = rest_with_lengths(human_rest(), usual);
  return clip;
}

void give_tempo(TempoChoice choice, double legs_m, StyledClip& clip) {
  if (choice.tempo == "body") {
    US_CHECK(legs_m > 0,
             "--tempo body: --legs tells how long the legs (thigh and shin) of who performs it are, metres");
    choice.tempo =
        printed("%.9g", static_cast<double>(body_tempo(static_cast<float>(legs_m), leg_length(clip.rest))));
  }
  TempoStream tempo(choice, clip.rest, clip.fps);
  std::vector<Pose> poses;
  const auto add = [&](const std::vector<PerformedFrame>& frames) {
    for (const PerformedFrame& frame : frames) poses.push_back(frame.pose);
  };
  for (const Pose& pose : clip.poses) {
    PerformedFrame frame;
    frame.pose = pose;
    frame.joints = frame.source.joints = forward_kinematics(clip.rest, pose).joints;
    add(tempo.push(frame));
  }
  add(tempo.finish());
  clip.poses = std::move(poses);
}

Metrics figures_of(const StyledClip& clip) {
  Metrics figures = style_figures(clip.poses, clip.rest, clip.fps);
  JointSequence joints;
  for (const Pose& pose : clip.poses) joints.push_back(forward_kinematics(clip.rest, pose).joints);
  figures.emplace_back("jerk", jerk(joints, clip.fps));
  return figures;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<StyleFrame> style_frames(const StyledClip& clip) {
  std::vector<StyleFrame> frames;
  for (const Pose& pose : clip.poses)
    frames.push_back({clip.rest, pose, frames.empty() ? 0.0f : static_cast<float>(1 / clip.fps)});
  return frames;
}

}  // namespace understudy::app
