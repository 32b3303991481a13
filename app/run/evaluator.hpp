// Turns what the method did with one sequence into the figures of report.json.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/run/case_folder.hpp"
#include "retarget/metrics/bent_volume.hpp"
#include "retarget/metrics/gap_score.hpp"
#include "retarget/metrics/hand_contact.hpp"
#include "retarget/metrics/metric_table.hpp"
#include "retarget/metrics/registered_truth.hpp"
#include "retarget/metrics/surface_metrics.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy::app {

/// Key and value, in the order of the report. Figures that cannot be measured for a sequence are left out.
using Metrics = std::vector<std::pair<std::string, double>>;

/// One finished frame, as the evaluator sees it. What is not there is null.
struct EvaluatedFrame {
  const Points* vertices = nullptr;       ///< of the target
  const Joints* joints = nullptr;         ///< of the target
  const Rotations* rotations = nullptr;   ///< local
  const Joints* source_joints = nullptr;  ///< extracted, repaired and smoothed
  const Joints* raw_joints = nullptr;     ///< extracted, as predicted by the network
  const Mesh* scan = nullptr;
  const Confidence* confidence = nullptr;   ///< of the raw joints
  LimbsSight limbs{};                       ///< what the source shows; figures of its legs need them
  const Extraction* truth = nullptr;        ///< of the source, where no sequence of it is known beforehand
  const Points* registered = nullptr;       ///< the scan's vertices, in the order that all frames share
  const SeenJoints* visibility = nullptr;   ///< of the source's joints
  const PredictedPeople* people = nullptr;  ///< in a scene
};

/// Collects a sequence. Surface figures are summed as the frames come; the slow ones (self_penetration,
/// inside) look at every tenth frame by default.
///
/// Where the truth has the source's own surface, too: hand_contact_kept, the share of the
/// source's contacts (a hand within 2 cm of torso, head, thighs, other arm or other hand; each frame, hand
/// and part is one) in which the target's same hand is within 2 cm of the same part; hand_contact_gap_mm, the
/// mean gap of the target in them; arm_buried, the share of hands and forearms inside the rest of the
/// target's body, and arm_buried_added, that less the source's own. floor_worst_mm is the deepest vertex of
/// all frames.
///
/// bent_volume is the volume about elbows, knees, shoulders and hips over that in T-pose, in frames in which
/// they are turned by more than 90 degrees; bent_volume_true is the truth's. hand_stretch and head_stretch
/// are PartStretch's, ..._true the truth's. Figures of gaps are GapScore's.
///
/// lowest_gap_mm is the median over frames of |the target's lowest vertex less the scan's|: a shoe that
/// floats is seen in its shadow. registered_rot_deg and registered_const_mm are RegisteredTruth's means, of
/// source_joints and rotations.
class Evaluator {
 public:
  /// truth may be null; target (its T-pose) too. slow_every: frames between looks of the slow figures.
  Evaluator(double fps, const Truth* truth, const Mesh* target, int slow_every = 10);
  void push(const EvaluatedFrame& frame);
  /// Somebody of a frame of a scene that was pushed, as extracted from a scan of them alone.
  void push_alone(size_t frame, size_t person, const Joints& joints);
  /// Frames that were not known, filled. A sequence of which gaps alone are pushed has their figures alone.
  void push_gap(const FilledGap& gap) { gaps_.push(gap, fps_); }
  /// How far the surface of any frame of such a sequence is from the true one.
  void push_gap_surface(double chamfer_m) { gaps_.push_surface(chamfer_m); }
  /// Throws Error when there are fewer or more frames than the truth has.
  Metrics metrics() const;
  /// Figures of the last frame's surface, by the metric's key; those not measured are left out.
  const std::map<std::string, double>& last() const { return last_; }

  // What was pushed, in order; empty where it was null.
  const JointSequence& joints() const { return seen_.joints; }
  const JointSequence& source_joints() const { return seen_.source_joints; }
  const JointSequence& raw_joints() const { return seen_.raw_joints; }
  const std::vector<Rotations>& rotations() const { return seen_.rotations; }
  const std::vector<Confidence>& confidence() const { return confidence_; }
  const RegisteredTruth& registered() const { return registered_; }
  /// Whether the source's legs are seen in half of the frames.
  bool has_legs() const { return seen_.has_legs; }
  const GapScore& gaps() const { return gaps_; }

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    double per_unit = 1;  // from metres, where the figure has another unit
    double value() const { return per_unit * sum / count; }
  };
  void note(const char* key, double value);
  void push_truth(const Extraction& truth);
  void push_surface(const EvaluatedFrame& frame);
  void push_lowest(const Points& vertices, const Points& scan);
  void push_hands(const Points& vertices);
  void push_bends(const Points& vertices, const Points& true_vertices);
  std::map<std::string, double> surface_figures() const;

  double fps_;
  int slow_every_;
  const Truth* truth_;
  std::optional<SelfPenetration> penetration_;
  std::optional<HandContact> hands_;  // of the target
  std::optional<BentVolume> bends_;   // of the target
  std::optional<PartStretch> parts_;  // of the target
  ContactsKept contacts_;
  SceneScore scene_;
  GapScore gaps_;
  int64_t frames_ = 0, without_legs_ = 0;
  MetricSequence seen_, true_;
  std::vector<Confidence> confidence_;
  std::map<std::string, double> last_;
  std::map<std::string, Mean> means_;  // of surface figures, by the metric's key
  double floor_worst_ = 0;
  std::vector<double> lowest_gaps_;  // millimetres
  RegisteredTruth registered_;
};

/// How a motion of this body is performed (style_metrics.hpp), at the tempo of its poses. `has_legs`: they
/// were seen.
Metrics style_figures(const std::vector<Pose>& poses, const Joints& rest, double fps, bool has_legs = true);

/// NaN where it is not there.
double value_of(const Metrics& metrics, const std::string& key);

/// Means of figures, in the order of their first appearance.
class MeanMetrics {
 public:
  void add(const std::string& key, double value);
  Metrics means() const;

 private:
  Metrics sums_;
  std::vector<double> counts_;  // beside sums_
};

/// The mean of each figure over the sequences that have it, in the order of first appearance.
Metrics mean_metrics(const std::vector<Metrics>& all);

}  // namespace understudy::app
