#include "app/run/evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/inside.hpp"

namespace understudy::app {
namespace {

constexpr float kBent = kPi / 2;

void put(Metrics& metrics, const char* key, double value) {
  if (std::isfinite(value)) metrics.emplace_back(key, value);
}

}  // namespace

Evaluator::Evaluator(double fps, const Truth* truth, const Mesh* target, int slow_every)
    : fps_(fps), slow_every_(slow_every), truth_(truth) {
  if (target && !target->is_cloud()) penetration_.emplace(target->vertices, target->faces);
  if (target && !target->is_cloud() && truth && truth->target_joints && !truth->source_gaps.empty())
    hands_.emplace(target->vertices, target->faces, *truth->target_joints);
  if (target && !target->is_cloud() && truth && truth->target_joints && !truth->rotations.empty())
    bends_.emplace(target->vertices, target->faces, *truth->target_joints);
  if (target && !target->is_cloud() && truth && truth->target_joints)
    parts_.emplace(target->vertices, target->faces, *truth->target_joints);
}

void Evaluator::push(const EvaluatedFrame& frame) {
  US_CHECK(!truth_ || frames_ < truth_->frames, "the source has more frames than the truth's ",
           truth_->frames);
  last_ = SurfaceFigures{};
  if (frame.joints) joints_.push_back(*frame.joints);
  if (frame.rotations) rotations_.push_back(*frame.rotations);
  if (frame.source_joints) source_joints_.push_back(*frame.source_joints);
  if (frame.raw_joints) raw_joints_.push_back(*frame.raw_joints);
  if (frame.confidence) confidence_.push_back(*frame.confidence);
  if (frame.vertices) push_surface(frame);
  if (frame.scan && frame.source_joints && frames_ % slow_every_ == 0)
    inside_.add(last_.inside = inside_share(*frame.scan, *frame.source_joints));
  ++frames_;
}

void Evaluator::push_surface(const EvaluatedFrame& frame) {
  const Points& p = *frame.vertices;
  if (truth_ && !truth_->vertices.empty()) {
    const Points q = truth_->frame_vertices(frames_);
    mpvd_.add(last_.mpvd_m = mean_vertex_error(p, q));
    pa_mpvd_.add(last_.pa_mpvd_m = aligned_vertex_error(p, q));
    medl_.add(last_.medl_mm = edge_length_error(p, q));
    last_.medl_mm *= 1000;
    if (bends_) push_bends(p, q);
    if (parts_) {
      hand_stretch_.add(parts_->hands(p)), hand_stretch_true_.add(parts_->hands(q));
      head_stretch_.add(parts_->head(p)), head_stretch_true_.add(parts_->head(q));
    }
  }
  floor_.add(last_.floor_mm = floor_penetration(p));
  floor_worst_ = std::max(floor_worst_, last_.floor_mm);
  last_.floor_mm *= 1000;
  if (hands_) push_hands(p);
  if (penetration_ && frames_ % slow_every_ == 0)
    self_penetration_.add(last_.self_penetration = penetration_->share(p));
}

void Evaluator::push_hands(const Points& vertices) {
  const size_t t = frames_;
  contacts_.add(truth_->source_gaps[t], hands_->gaps(vertices));
  if (truth_->source_buried.empty()) return;
  const double buried = hands_->buried(vertices);
  buried_.add(buried);
  buried_added_.add(buried - static_cast<double>(truth_->source_buried[t]));
}

void Evaluator::push_bends(const Points& vertices, const Points& true_vertices) {
  const Rotations& local = truth_->rotations[frames_];
  for (size_t bend = 0; bend < BentVolume::kBends.size(); ++bend) {
    const Mat3& turn = local[BentVolume::kBends[bend]];
    if (geodesic_angle(turn, Mat3::Identity()) < kBent) continue;
    const double kept = bends_->kept(bend, vertices), should = bends_->kept(bend, true_vertices);
    if (!std::isfinite(kept) || !std::isfinite(should)) continue;
    bent_.add(kept);
    bent_true_.add(should);
  }
}

Metrics Evaluator::metrics() const {
  US_CHECK(frames_ > 0, "there are no frames to evaluate");
  US_CHECK(!truth_ || frames_ == truth_->frames, "the source has ", frames_, " frames, the truth ",
           truth_ ? truth_->frames : 0);
  Metrics result;
  if (truth_) add_truth(result);
  if (truth_) add_extraction(result);
  if (!source_joints_.empty()) put(result, "bone_drift", bone_drift(source_joints_));
  if (!joints_.empty()) put(result, "foot_skate", foot_skate(joints_, fps_));
  if (floor_.count > 0) put(result, "floor_mm", 1000 * floor_.sum / floor_.count);
  if (floor_.count > 0) put(result, "floor_worst_mm", 1000 * floor_worst_);
  if (contacts_.count() > 0) {
    put(result, "hand_contacts", contacts_.count());
    put(result, "hand_contact_kept", contacts_.kept());
    put(result, "hand_contact_gap_mm", 1000 * contacts_.gap_m());
  }
  if (buried_.count > 0) {
    put(result, "arm_buried", buried_.sum / buried_.count);
    put(result, "arm_buried_added", buried_added_.sum / buried_added_.count);
  }
  if (bent_.count > 0) {
    put(result, "bent_volume", bent_.sum / bent_.count);
    put(result, "bent_volume_true", bent_true_.sum / bent_true_.count);
  }
  for (const auto& [key, mean] : {std::pair("hand_stretch", &hand_stretch_),
                                  {"hand_stretch_true", &hand_stretch_true_},
                                  {"head_stretch", &head_stretch_},
                                  {"head_stretch_true", &head_stretch_true_}})
    if (mean->count > 0) put(result, key, mean->sum / mean->count);
  if (!joints_.empty()) put(result, "jerk", jerk(joints_, fps_));
  if (self_penetration_.count > 0)
    put(result, "self_penetration", self_penetration_.sum / self_penetration_.count);
  if (inside_.count > 0) put(result, "inside", inside_.sum / inside_.count);
  return result;
}

void Evaluator::add_truth(Metrics& result) const {
  if (!joints_.empty() && !truth_->joints.empty()) {
    const JointSequence aligned = aligned_joints(joints_, truth_->joints);
    put(result, "mpjpe_m", mean_joint_error(joints_, truth_->joints));
    put(result, "pa_mpjpe_m", mean_joint_error(aligned, truth_->joints));
    put(result, "acc", acceleration_error(joints_, truth_->joints, fps_));
    put(result, "pa_acc", acceleration_error(aligned, truth_->joints, fps_));
  }
  if (mpvd_.count > 0) {
    put(result, "mpvd_m", mpvd_.sum / mpvd_.count);
    put(result, "pa_mpvd_m", pa_mpvd_.sum / pa_mpvd_.count);
    put(result, "medl_mm", 1000 * medl_.sum / medl_.count);
  }
  if (!rotations_.empty() && !truth_->rotations.empty()) {
    const RotationError error = rotation_error(rotations_, truth_->rotations);
    put(result, "rot_deg", error.all_deg);
    put(result, "head_deg", error.head_deg);
    put(result, "wrist_deg", error.wrist_deg);
    put(result, "foot_deg", error.foot_deg);
  }
}

void Evaluator::add_extraction(Metrics& result) const {
  if (source_joints_.empty() || truth_->source_joints.empty()) return;
  put(result, "extraction_mpjpe_mm", 1000 * mean_joint_error(source_joints_, truth_->source_joints));
  put(result, "extraction_swap_rate", swap_rate(source_joints_, truth_->source_joints));
  put(result, "extraction_flip_rate", flip_rate(source_joints_, truth_->source_joints));
  if (raw_joints_.empty()) return;
  put(result, "extraction_raw_mpjpe_mm", 1000 * mean_joint_error(raw_joints_, truth_->source_joints));
}

Metrics mean_metrics(const std::vector<Metrics>& all) {
  Metrics mean;
  std::vector<int> counts;
  for (const Metrics& one : all)
    for (const auto& figure : one) {
      const std::string& key = figure.first;
      const double value = figure.second;
      const auto known =
          std::find_if(mean.begin(), mean.end(), [&](const auto& m) { return m.first == key; });
      if (known == mean.end()) {
        mean.emplace_back(key, value);
        counts.push_back(1);
      } else {
        known->second += value;
        ++counts[known - mean.begin()];
      }
    }
  for (size_t i = 0; i < mean.size(); ++i) mean[i].second /= counts[i];
  return mean;
}

}  // namespace understudy::app
