#include "app/cli/lift_evaluation.hpp"

#include <array>
#include <cmath>

#include "app/run/case_source.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/retargeted_source.hpp"
#include "app/run/target_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/metrics/joint_metrics.hpp"

namespace understudy::app {
namespace {

/// Joints that are points of a picture, or nearly so.
constexpr std::array<int, 14> kSeenInPictures = {
    LeftHip, RightHip,     LeftKnee,      RightKnee, LeftAnkle,  RightAnkle, Neck,
    Head,    LeftShoulder, RightShoulder, LeftElbow, RightElbow, LeftWrist,  RightWrist};

struct LiftedTrack {
  JointSequence raw, smooth, target, truth, target_truth;
  std::vector<Confidence> confidence;
};

double points_error(const JointSequence& predicted, const JointSequence& truth) {
  double sum = 0;
  for (size_t t = 0; t < truth.size(); ++t)
    for (const int j : kSeenInPictures)
      sum += static_cast<double>((predicted[t].row(j) - truth[t].row(j)).norm());
  return sum / static_cast<double>(truth.size() * kSeenInPictures.size());
}

/// Mean expected error, and its correlation with the real one, over joints and frames.
std::array<double, 2> expected_errors(const LiftedTrack& track, const JointSequence& scaled) {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (size_t t = 0; t < scaled.size(); ++t)
    for (int j = 0; j < kJointCount; ++j) {
      const auto a = static_cast<double>(expected_error_for(track.confidence[t][j])),
                 b = static_cast<double>((scaled[t].row(j) - track.truth[t].row(j)).norm());
      ++n, x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
    }
  const double spread = std::sqrt((xx / n - x * x / (n * n)) * (yy / n - y * y / (n * n)));
  return {x / n, (xy / n - x * y / (n * n)) / spread};
}

LiftedTrack performed(const Case& c, const EvalOptions& options, const Truth& truth, CaseResult& result) {
  Networks networks = nn::load_networks(network_options(options.how));
  TargetOptions aim;
  aim.path = c.target;
  aim.import.units = "m";
  aim.import.up = "y";
  aim.import.floor = 0.0f;
  aim.forward = false;
  aim.rig = Rig::Ours;
  const auto target = open_target(aim, networks);
  Retargeter retargeter(std::move(networks), retarget_options(options.how));
  retargeter.set_target(target->target);
  SourceOptions from = case_source(c);
  const Npz npz = read_npz(c.truth);
  const auto fov = npz.find("fov_deg");
  US_CHECK(fov != npz.end() && fov->second.values.size() == 1, c.truth, ": has no fov_deg, one number");
  from.fov = static_cast<double>(fov->second.values[0]);
  from.pitch = 0;  // the truth is in the camera's axes
  const auto source = open_source(from);
  RetargetedSource retargeted(*source, retargeter, from, source_tools(options.how));
  LiftedTrack track;
  for (size_t t = 0; const auto frame = retargeted.next(); ++t) {
    check_interrupt("in case " + c.name);
    US_CHECK(t < truth.source_joints.size() && t < truth.joints.size(), c.truth, ": has too few frames");
    result.latency.add(frame->times);
    result.flagged += frame->result.flagged;
    track.smooth.push_back(source_joints(frame->result));
    track.raw.push_back(frame->result.flagged ? track.smooth.back() : frame->result.observed.joints);
    track.confidence.push_back(frame->result.observed.confidence);
    track.target.push_back(frame->result.joints);
    track.truth.push_back(truth.source_joints[t]);
    track.target_truth.push_back(truth.joints[t]);
  }
  retargeted.check_used();
  return track;
}

}  // namespace

void evaluate_lifted(const Case& c, const EvalOptions& options, CaseResult& result) {
  const Truth truth = read_truth(c.truth);
  const LiftedTrack track = performed(c, options, truth, result);
  result.frames = static_cast<int64_t>(track.truth.size());
  const JointSequence scaled = scaled_joints(track.raw, track.truth),
                      on_target = scaled_joints(track.target, track.target_truth);
  const auto [expected, correlation] = expected_errors(track, scaled);
  const auto mm = [](double metres) { return 1000 * metres; };
  result.metrics = {
      {"n_mpjpe_mm", mm(mean_joint_error(scaled, track.truth))},
      {"pa_mpjpe_mm", mm(mean_joint_error(aligned_joints(track.raw, track.truth), track.truth))},
      {"n_mpjpe_points_mm", mm(points_error(scaled, track.truth))},
      {"n_mpjpe_smooth_mm", mm(mean_joint_error(scaled_joints(track.smooth, track.truth), track.truth))},
      {"swaps", 100 * swap_rate(scaled, track.truth)},
      {"flips", 100 * flip_rate(scaled, track.truth)},
      {"expected_mm", mm(expected)},
      {"confidence_corr", correlation},
      {"target_pa_mpjpe_m",
       mean_joint_error(aligned_joints(track.target, track.target_truth), track.target_truth)},
      {"target_swaps", 100 * swap_rate(on_target, track.target_truth)},
      {"target_flips", 100 * flip_rate(on_target, track.target_truth)}};
}

}  // namespace understudy::app
