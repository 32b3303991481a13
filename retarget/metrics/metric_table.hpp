// The table of metrics: key, name, unit and function of every figure in reports, the studio and CSV.
#pragma once

#include <string>
#include <vector>

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {

/// One body's motion, or its truth, as metrics see it.
/// Each list has a frame an entry, or is empty: not known.
struct MetricSequence {
  JointSequence joints;                     ///< of the target, world, metres
  std::vector<Rotations> rotations;         ///< of the target, local
  JointSequence source_joints;              ///< seen in the source, repaired and smoothed
  JointSequence raw_joints;                 ///< as extracted
  std::vector<float> confidence;            ///< of the extraction, 0..1
  std::vector<SeenJoints> visibility = {};  ///< of the source's joints
  bool has_legs = true;                     ///< false: the source's legs are not seen in half of the frames
  bool has_style = false;                   ///< whether a style or a tempo is of interest
};

/// What a metric looks at. It is asked only where all of that is known, for at least one frame.
enum MetricNeeds : unsigned {
  kNeedsJoints = 1,
  kNeedsRotations = 2,
  kNeedsSource = 4,
  kNeedsRaw = 8,
  kNeedsConfidence = 16,
  kNeedsTruth = 32,  ///< the truth of the same, too
  kNeedsVisibility = 64,
  kNeedsScene = 128,   ///< the truth of a scene: who is in it, and whose each point is
  kNeedsLegs = 256,    ///< seen
  kNeedsGaps = 512,    ///< frames that were not known, and their truth
  kNeedsRig = 1024,    ///< the true rig of a body of whatever kind
  kNeedsStyle = 2048,  ///< it is asked how the motion is performed
};

enum class Better { Lower, Higher, Neither };

/// One row. Its key ends in its unit where that is one of length or angle.
struct Metric {
  const char *key, *label;  ///< "pa_mpjpe_m" in reports, "PA-MPJPE" for people
  const char* unit;         ///< "m", "m/s"; empty: a share or a count
  int digits;               ///< after the point, in tables
  bool per_frame;           ///< frames have it, too: it can be plotted
  Better better;
  unsigned needs = 0;  ///< MetricNeeds, together
  /// The figure of a sequence p, its truth q, at so many frames a second; NaN where it is undefined. Null: it
  /// is of surfaces, which are not kept, and is summed as frames come (app/run/evaluator.hpp).
  double (*of)(const MetricSequence& p, const MetricSequence& q, double fps) = nullptr;
  int after = 0;  ///< frames behind a frame that its own figure looks at
  /// The figures of all frames, where that is not `of` each frame and those after it.
  std::vector<float> (*series)(const MetricSequence& p, const MetricSequence& q, double fps) = nullptr;
};

/// All of them, in the order of reports.
const std::vector<Metric>& metric_table();
/// Null when there is none with this key.
const Metric* find_metric(const std::string& key);

/// Whether it is of surfaces: summed as frames come, not made from what is kept.
bool is_of_surfaces(const Metric& metric);
/// Whether all that the metric looks at is known in p, and in q where it needs the truth.
bool is_known(const Metric& metric, const MetricSequence& p, const MetricSequence& q);
/// The figure of every frame, `frames` in all, NaN where it is undefined. For metrics with a function and
/// `per_frame`.
std::vector<float> per_frame_figures(const Metric& metric, const MetricSequence& p, const MetricSequence& q,
                                     size_t frames, double fps);

}  // namespace understudy
