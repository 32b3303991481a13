#include "retarget/metrics/metric_table.hpp"

#include <cmath>
#include <iterator>
#include <limits>

#include "retarget/metrics/style_metrics.hpp"

namespace understudy {

namespace {

using Sequence = MetricSequence;
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr unsigned kOfJoints = kNeedsJoints | kNeedsTruth, kOfRotations = kNeedsRotations | kNeedsTruth,
                   kOfSource = kNeedsSource | kNeedsTruth, kOfVisibility = kNeedsVisibility | kNeedsTruth;

double aligned_error(const Sequence& p, const Sequence& q, double) {
  return mean_joint_error(aligned_joints(p.joints, q.joints), q.joints);
}

double aligned_acceleration_error(const Sequence& p, const Sequence& q, double fps) {
  return acceleration_error(aligned_joints(p.joints, q.joints), q.joints, fps);
}

template <double RotationError::*part>
double turned(const Sequence& p, const Sequence& q, double) {
  return rotation_error(p.rotations, q.rotations).*part;
}

/// Mean over frames and the joints that end thighs, shins, upper arms and forearms.
double limb_error_mm(const Sequence& p, const Sequence& q, double) {
  constexpr int kEnds[] = {LeftKnee,  RightKnee,  LeftAnkle, RightAnkle,
                           LeftElbow, RightElbow, LeftWrist, RightWrist};
  double sum = 0;
  for (size_t t = 0; t < p.source_joints.size(); ++t)
    for (const int j : kEnds)
      sum += static_cast<double>((p.source_joints[t].row(j) - q.source_joints[t].row(j)).norm());
  return 1000 * sum / (static_cast<double>(p.source_joints.size()) * std::size(kEnds));
}

/// Second difference of joint positions at 30 frames/s around frame t.
Joints bend(const JointSequence& joints, size_t t, double fps) {
  const float per_frame = static_cast<float>(fps * fps / 900);
  return per_frame * (joints[t + 1] - 2 * joints[t] + joints[t - 1]);
}

std::vector<float> acceleration_errors(const Sequence& p, const Sequence& q, double fps) {
  std::vector<float> values(p.joints.size(), kNoValue);
  for (size_t t = 1; t + 1 < values.size(); ++t)
    values[t] = (bend(p.joints, t, fps) - bend(q.joints, t, fps)).rowwise().norm().mean();
  return values;
}

/// How far bone lengths are from their mean over time, mean over bones, share of the length.
std::vector<float> bone_drifts(const Sequence& p, const Sequence&, double) {
  using Lengths = Eigen::Array<float, kJointCount, 1>;
  const auto lengths = [](const Joints& joints) {
    Lengths result = Lengths::Zero();
    for (int j = 1; j < kJointCount; ++j) result[j] = (joints.row(j) - joints.row(kParents[j])).norm();
    return result;
  };
  Lengths usual = Lengths::Zero();
  for (const Joints& joints : p.source_joints)
    usual += lengths(joints) / static_cast<float>(p.source_joints.size());
  std::vector<float> values;
  for (const Joints& joints : p.source_joints) {
    const Lengths now = lengths(joints);
    float sum = 0;
    for (int j = 1; j < kJointCount; ++j)
      if (usual[j] > 1e-4f) sum += std::abs(now[j] - usual[j]) / usual[j];
    values.push_back(sum / (kJointCount - 1));
  }
  return values;
}

/// Mean over frames and the eight pairs of bones of the source's skeleton of |left - right| over the mean of
/// both lengths: 0 where the sides are alike, 2 where one has none. Without truth. The left joint of a pair
/// comes directly before the right one (SMPL's order).
double bone_asymmetry(const Sequence& p, const Sequence&, double) {
  const auto length = [](const Joints& joints, int j) {
    return (joints.row(j) - joints.row(kParents[j])).cast<double>().norm();
  };
  const int lefts[] = {LeftHip,    LeftKnee,     LeftAnkle, LeftFoot,
                       LeftCollar, LeftShoulder, LeftElbow, LeftWrist};
  double sum = 0;
  for (const Joints& joints : p.source_joints)
    for (const int left : lefts) {
      const double l = length(joints, left), r = length(joints, left + 1);
      if (l + r > 0) sum += std::abs(l - r) / ((l + r) / 2);
    }
  return sum / (static_cast<double>(p.source_joints.size()) * std::size(lefts));
}

std::vector<float> confidences(const Sequence& p, const Sequence&, double) {
  return p.confidence;
}

/// `count` frames from `first` on.
template <class List>
List part_of(const List& list, size_t first, size_t count) {
  return list.empty() ? list
                      : List(list.begin() + static_cast<std::ptrdiff_t>(first),
                             list.begin() + static_cast<std::ptrdiff_t>(first + count));
}
Sequence part_of(const Sequence& s, size_t first, size_t count) {
  return {part_of(s.joints, first, count),
          part_of(s.rotations, first, count),
          part_of(s.source_joints, first, count),
          part_of(s.raw_joints, first, count),
          {},
          part_of(s.visibility, first, count)};
}

/// Of registered surfaces, of half bodies, and of several people: whose each point is, and who is who.
std::vector<Metric> rows_of_scenes() {
  using S = const Sequence&;
  const Better lower = Better::Lower, higher = Better::Higher, neither = Better::Neither;
  const bool each = true, whole = false;
  return {
      {"registered_rot_deg", "Turn of bones off the registered surface's", "deg", 1, whole, lower},
      {"registered_const_mm", "Wander of joints in the registered surface", "mm", 1, whole, lower},
      {"extraction_seen_mm", "Extraction error, joints seen", "mm", 1, each, lower, kOfSource | kOfVisibility,
       [](S p, S q, double) {
         return 1000 * seen_joint_error(p.source_joints, q.source_joints, q.visibility);
       }},
      {"visibility_right", "Visibility right", "", 3, each, higher, kOfVisibility,
       [](S p, S q, double) { return visibility_right(p.visibility, q.visibility); }},
      {"points_owner_right", "Points whose owner is right", "", 3, whole, higher, kNeedsScene},
      {"identities_exchanged", "Identities exchanged", "", 2, whole, lower, kNeedsScene},
      {"people_missed", "People missed", "", 3, whole, lower, kNeedsScene},
      {"people_invented", "People invented, a frame", "", 3, whole, lower, kNeedsScene},
      {"people_mm", "Extraction error of people", "mm", 1, whole, lower, kNeedsScene},
      {"people_alone_mm", "The same people alone", "mm", 1, whole, neither, kNeedsScene},
      {"people_over_alone", "Extraction error over alone", "", 2, whole, lower, kNeedsScene},
      {"people_touching_mm", "Extraction error where people touch", "mm", 1, whole, lower, kNeedsScene},
      {"people_touching_alone_mm", "The same people alone, where they touch", "mm", 1, whole, neither,
       kNeedsScene},
      {"people_touching_over_alone", "Extraction error over alone where people touch", "", 2, whole, lower,
       kNeedsScene}};
}

std::vector<Metric> rows_of_gaps() {
  const Better lower = Better::Lower, higher = Better::Higher, neither = Better::Neither;
  const bool whole = false;
  const char* const per_frame2 = "m/frame\xC2\xB2";
  return {{"gap_mpjpe_m", "MPJPE in gaps", "m", 4, whole, lower, kNeedsGaps},
          {"gap_rel_mpjpe_m", "MPJPE in gaps, less the pelvis", "m", 4, whole, lower, kNeedsGaps},
          {"mve_m", "Mean vertex error in gaps", "m", 4, whole, lower, kNeedsGaps},
          {"mve_3_m", "Mean vertex error, predicted by 3 frames", "m", 4, whole, lower, kNeedsGaps},
          {"mve_8_m", "Mean vertex error, predicted by 8 frames", "m", 4, whole, lower, kNeedsGaps},
          {"mve_15_m", "Mean vertex error, predicted by 15 frames", "m", 4, whole, lower, kNeedsGaps},
          {"chamfer_m", "Chamfer distance of the surfaces", "m", 4, whole, lower, kNeedsGaps},
          {"gap_foot_skate", "Foot skate in gaps", "m/s", 3, whole, lower, kNeedsGaps},
          {"gap_foot_skate_true", "Foot skate in gaps, truth", "m/s", 3, whole, neither, kNeedsGaps},
          {"gap_acc", "Acceleration error in gaps", per_frame2, 4, whole, lower, kNeedsGaps},
          {"seam_m", "Acceleration error at the ends of gaps", "m", 4, whole, lower, kNeedsGaps},
          {"spread", "Correlation of doubt and error in gaps", "", 2, whole, higher, kNeedsGaps}};
}

/// Of rigs found in scans (rig_metrics.hpp).
std::vector<Metric> rows_of_rigs() {
  const Better lower = Better::Lower, higher = Better::Higher, neither = Better::Neither;
  const bool whole = false;
  return {
      {"joint_recall", "True joints found", "", 3, whole, higher, kNeedsRig},
      {"joint_precision", "Found joints that are true", "", 3, whole, higher, kNeedsRig},
      {"joint_error_pct", "Error of joints found, of the body", "%", 2, whole, lower, kNeedsRig},
      {"hinge_deg", "Axis error of hinges", "deg", 1, whole, lower, kNeedsRig},
      {"part_ri", "Rand index of parts", "", 3, whole, higher, kNeedsRig},
      {"part_ari", "Adjusted Rand index of parts", "", 3, whole, higher, kNeedsRig},
      {"tree_f1", "F1 of the tree's edges", "", 3, whole, higher, kNeedsRig},
      {"track_pct", "Error of points carried along, of the body", "%", 2, whole, lower, kNeedsRig},
      {"surface_pct", "Surface off the scan, of the body", "%", 2, whole, lower, kNeedsRig},
      {"retarget_pct", "Error of another body's performance, of the body", "%", 2, whole, lower, kNeedsRig},
      {"sc", "Semantic consistency", "", 3, whole, higher, kNeedsRig},
      {"sc_keypoints", "Keypoints of the semantic consistency", "", 0, whole, neither, kNeedsRig},
      {"cd_1e4", "Voxel Chamfer distance x 1e4", "", 2, whole, lower, kNeedsRig},
      {"m_cd", "Voxel Chamfer distance of what moves", "", 4, whole, lower, kNeedsRig},
      {"true_parts", "True parts", "", 0, whole, neither, kNeedsRig},
      {"found_parts", "Parts found", "", 0, whole, neither, kNeedsRig},
      {"retarget_scan_pct", "The same of a body of which there is one scan", "%", 2, whole, lower, kNeedsRig},
      {"surface_even_pct", "Surface off the scan, even frames, found in them", "%", 2, whole, lower,
       kNeedsRig},
      {"surface_odd_pct", "The same in odd frames, followed", "%", 2, whole, lower, kNeedsRig},
      {"surface_held_out", "Surface off in odd frames over even ones", "", 2, whole, lower, kNeedsRig}};
}

std::vector<Metric> rows_of_one() {
  using S = const Sequence&;
  const Better lower = Better::Lower, higher = Better::Higher, neither = Better::Neither;
  const bool each = true, whole = false;
  const char *const per_frame2 = "m/frame\xC2\xB2", *const per_s3 = "m/s\xC2\xB3";
  return {
      {"confidence", "Confidence", "", 2, each, higher, kNeedsConfidence, nullptr, 0, confidences},
      {"mpjpe_m", "MPJPE", "m", 4, each, lower, kOfJoints,
       [](S p, S q, double) { return mean_joint_error(p.joints, q.joints); }},
      {"pa_mpjpe_m", "PA-MPJPE", "m", 4, each, lower, kOfJoints, aligned_error},
      {"acc", "Acceleration error", per_frame2, 4, each, lower, kOfJoints,
       [](S p, S q, double fps) { return acceleration_error(p.joints, q.joints, fps); }, 0,
       acceleration_errors},
      {"pa_acc", "PA acceleration error", per_frame2, 4, whole, lower, kOfJoints, aligned_acceleration_error},
      {"mpvd_m", "MPVD", "m", 4, each, lower, kNeedsTruth},
      {"pa_mpvd_m", "PA-MPVD", "m", 4, each, lower, kNeedsTruth},
      {"medl_mm", "MEDL", "mm", 3, each, lower, kNeedsTruth},
      {"rot_deg", "Rotation error", "deg", 1, each, lower, kOfRotations, turned<&RotationError::all_deg>},
      {"head_deg", "Head rotation error", "deg", 1, each, lower, kOfRotations,
       turned<&RotationError::head_deg>},
      {"wrist_deg", "Wrist rotation error", "deg", 1, each, lower, kOfRotations,
       turned<&RotationError::wrist_deg>},
      {"foot_deg", "Foot rotation error", "deg", 1, each, lower, kOfRotations,
       turned<&RotationError::foot_deg>},
      {"extraction_mpjpe_mm", "Extraction error", "mm", 1, each, lower, kOfSource,
       [](S p, S q, double) { return 1000 * mean_joint_error(p.source_joints, q.source_joints); }},
      {"extraction_swap_rate", "Left-right swaps", "", 4, each, lower, kOfSource,
       [](S p, S q, double) { return swap_rate(p.source_joints, q.source_joints); }},
      {"extraction_flip_rate", "Front-back flips", "", 4, whole, lower, kOfSource,
       [](S p, S q, double) { return flip_rate(p.source_joints, q.source_joints); }},
      {"extraction_raw_mpjpe_mm", "Raw extraction error", "mm", 1, whole, lower, kNeedsRaw | kNeedsTruth,
       [](S p, S q, double) { return 1000 * mean_joint_error(p.raw_joints, q.source_joints); }},
      {"bone_drift", "Bone length drift", "", 4, each, lower, kNeedsSource,
       [](S p, S, double) { return bone_drift(p.source_joints); }, 0, bone_drifts},
      {"bone_asymmetry", "Left-right bone difference", "", 4, each, lower, kNeedsSource | kNeedsLegs,
       bone_asymmetry},
      {"foot_skate", "Foot skate", "m/s", 3, each, lower, kNeedsJoints | kNeedsLegs,
       [](S p, S, double fps) { return foot_skate(p.joints, fps); }, 1},
      {"floor_mm", "Floor penetration", "mm", 2, each, lower, kNeedsLegs},
      {"floor_worst_mm", "Deepest floor penetration", "mm", 1, whole, lower, kNeedsLegs},
      {"hand_contacts", "Hand contacts of the source", "", 0, whole, neither, kNeedsTruth},
      {"hand_contact_kept", "Hand contacts kept", "", 2, whole, higher, kNeedsTruth},
      {"hand_contact_gap_mm", "Gap in hand contacts", "mm", 1, whole, lower, kNeedsTruth},
      {"arm_buried", "Arms inside the body", "", 4, whole, neither, kNeedsTruth},
      {"arm_buried_added", "Arms inside the body, beyond the source's", "", 4, whole, lower, kNeedsTruth},
      {"bent_volume", "Volume kept in bends", "", 3, whole, neither, kNeedsTruth},
      {"bent_volume_true", "Volume kept in bends, truth", "", 3, whole, neither, kNeedsTruth},
      {"hand_stretch", "Hand stretch", "", 4, whole, neither, kNeedsTruth},
      {"hand_stretch_true", "Hand stretch, truth", "", 4, whole, neither, kNeedsTruth},
      {"head_stretch", "Head stretch", "", 4, whole, neither, kNeedsTruth},
      {"head_stretch_true", "Head stretch, truth", "", 4, whole, neither, kNeedsTruth},
      {"jerk", "Jerk", per_s3, 2, each, lower, kNeedsJoints,
       [](S p, S, double fps) { return jerk(p.joints, fps); }, 3},
      {"self_penetration", "Self-penetration", "", 4, each, lower},
      {"inside", "Joints inside the scan", "", 3, each, higher},
      {"extraction_limb_mm", "Knees, ankles, elbows and wrists, extraction error", "mm", 1, each, lower,
       kOfSource, limb_error_mm},
      {"lowest_gap_mm", "Lowest vertex off the scan's", "mm", 1, each, lower}};
}

/// How a motion is performed.
std::vector<Metric> rows_of_styles() {
  using S = const Sequence&;
  constexpr auto neither = Better::Neither;
  constexpr unsigned joints = kNeedsStyle | kNeedsJoints;
  return {{"body_sway_deg", "Body sway", "deg", 1, false, neither, joints,
           [](S p, S, double fps) { return body_sway_deg(p.joints, fps); }},
          {"head_turn", "Head turning", "deg/s", 1, true, neither, kNeedsStyle | kNeedsRotations,
           [](S p, S, double fps) { return head_turn_deg_s(p.rotations, fps); }, 1,
           [](S p, S, double fps) { return head_turns_deg_s(p.rotations, fps); }},
          {"pelvis_speed", "Speed of the pelvis", "legs/s", 3, true, neither, joints,
           [](S p, S, double fps) { return pelvis_speed_legs(p.joints, fps); }, 1,
           [](S p, S, double fps) { return pelvis_speeds_legs(p.joints, fps); }},
          {"rise_s", "Rise of a gesture", "s", 3, false, neither, joints,
           [](S p, S, double fps) { return rise_s(p.joints, fps); }},
          {"flight_gravity", "Gravity in flights", "m/s\u00b2", 2, false, neither, joints | kNeedsLegs,
           [](S p, S, double fps) { return flight_gravity(p.joints, fps); }},
          {"cycle_s", "Step cycle", "s", 3, false, neither, joints | kNeedsLegs,
           [](S p, S, double fps) { return cycle_s(p.joints, fps); }},
          {"stance_slide", "Slide of standing feet", "m/s", 3, false, Better::Lower, joints | kNeedsLegs,
           [](S p, S, double fps) { return stance_slide(p.joints, fps); }}};
}

}  // namespace

const std::vector<Metric>& metric_table() {
  static const std::vector<Metric> table = [] {
    std::vector<Metric> all = rows_of_one();
    for (const Metric& row : rows_of_scenes()) all.push_back(row);
    for (const Metric& row : rows_of_gaps()) all.push_back(row);
    for (const Metric& row : rows_of_rigs()) all.push_back(row);
    for (const Metric& row : rows_of_styles()) all.push_back(row);
    return all;
  }();
  return table;
}

const Metric* find_metric(const std::string& key) {
  for (const Metric& metric : metric_table())
    if (key == metric.key) return &metric;
  return nullptr;
}

bool is_of_surfaces(const Metric& metric) {
  return metric.of == nullptr && metric.series == nullptr;
}

bool is_known(const Metric& metric, const MetricSequence& p, const MetricSequence& q) {
  const auto needs = [&](unsigned what) { return (metric.needs & what) != 0; };
  const auto there = [&](const auto& in_p, const auto& in_q) {
    return !in_p.empty() && (!needs(kNeedsTruth) || !in_q.empty());
  };
  return (!needs(kNeedsStyle) || p.has_style) && (!needs(kNeedsLegs) || p.has_legs) &&
         (!needs(kNeedsJoints) || there(p.joints, q.joints)) &&
         (!needs(kNeedsRotations) || there(p.rotations, q.rotations)) &&
         (!needs(kNeedsSource) || there(p.source_joints, q.source_joints)) &&
         (!needs(kNeedsRaw) || there(p.raw_joints, q.source_joints)) &&
         (!needs(kNeedsConfidence) || !p.confidence.empty()) &&
         (!needs(kNeedsVisibility) || there(p.visibility, q.visibility));
}

std::vector<float> per_frame_figures(const Metric& metric, const MetricSequence& p, const MetricSequence& q,
                                     size_t frames, double fps) {
  std::vector<float> values(frames, kNoValue);
  if (metric.series) {
    values = metric.series(p, q, fps);
    values.resize(frames, kNoValue);
    return values;
  }
  const auto after = static_cast<size_t>(metric.after);
  for (size_t t = 0; t + after < frames; ++t)
    values[t] = static_cast<float>(metric.of(part_of(p, t, after + 1), part_of(q, t, after + 1), fps));
  return values;
}

}  // namespace understudy
