#include "app/run/evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/inside.hpp"

namespace understudy::app {
namespace {

constexpr float kBent = kPi / 2;

}  // namespace

Evaluator::Evaluator(double fps, const Truth* truth, const Mesh* target, int slow_every)
    : fps_(fps), slow_every_(slow_every), truth_(truth) {
  const bool surface = target && !target->is_cloud();
  if (surface) penetration_.emplace(target->vertices, target->faces);
  if (surface && truth && truth->target_joints) {
    parts_.emplace(target->vertices, target->faces, *truth->target_joints);
    if (!truth->source_gaps.empty()) hands_.emplace(target->vertices, target->faces, *truth->target_joints);
    if (!truth->rotations.empty()) bends_.emplace(target->vertices, target->faces, *truth->target_joints);
  }
  if (truth) true_ = {truth->joints, truth->rotations, truth->source_joints, {}, {}, truth->source_seen};
  means_["medl_mm"].per_unit = means_["floor_mm"].per_unit = 1000;
}

void Evaluator::push(const EvaluatedFrame& frame) {
  US_CHECK(!truth_ || frames_ < truth_->frames, "the source has more frames than the truth's ",
           truth_->frames);
  last_.clear();
  if (frame.joints) seen_.joints.push_back(*frame.joints);
  if (frame.rotations) seen_.rotations.push_back(*frame.rotations);
  if (frame.source_joints) seen_.source_joints.push_back(*frame.source_joints);
  if (frame.raw_joints) seen_.raw_joints.push_back(*frame.raw_joints);
  if (frame.confidence) confidence_.push_back(*frame.confidence);
  if (frame.truth) push_truth(*frame.truth);
  if (frame.registered && frame.source_joints && frame.rotations)
    registered_.push(*frame.registered, *frame.source_joints, global_rotations(*frame.rotations));
  if (frame.visibility) seen_.visibility.push_back(*frame.visibility);
  if (frame.people && truth_ && !truth_->scene.empty()) scene_.push(*frame.people, truth_->scene[frames_]);
  if (frame.vertices) push_surface(frame);
  if (frame.scan && frame.source_joints && frames_ % slow_every_ == 0)
    note("inside", inside_share(*frame.scan, (*frame.source_joints)(joints_seen(frame.limbs), Eigen::all)));
  if (legs_missing(frame.limbs)) ++without_legs_;
  seen_.has_legs = 2 * without_legs_ < ++frames_;
}

void Evaluator::push_alone(size_t frame, size_t person, const Joints& joints) {
  US_CHECK(truth_ && frame < truth_->scene.size() && person < truth_->scene[frame].people.size(),
           "the truth has no person ", person + 1, " in frame ", frame + 1);
  scene_.push_alone(frame, person, joints, truth_->scene[frame].people[person]);
}

void Evaluator::note(const char* key, double value) {
  Mean& mean = means_[key];
  mean.sum += value, ++mean.count;
  last_[key] = mean.per_unit * value;
}

void Evaluator::push_truth(const Extraction& truth) {
  true_.source_joints.push_back(truth.joints);
  if (truth.global) true_.rotations.push_back(local_rotations(*truth.global));
}

void Evaluator::push_surface(const EvaluatedFrame& frame) {
  const Points& p = *frame.vertices;
  if (truth_ && !truth_->vertices.empty()) {
    const Points q = truth_->frame_vertices(frames_);
    note("mpvd_m", mean_vertex_error(p, q));
    note("pa_mpvd_m", aligned_vertex_error(p, q));
    note("medl_mm", edge_length_error(p, q));
    if (bends_) push_bends(p, q);
    if (parts_) {
      note("hand_stretch", parts_->hands(p)), note("hand_stretch_true", parts_->hands(q));
      note("head_stretch", parts_->head(p)), note("head_stretch_true", parts_->head(q));
    }
  }
  const double depth = floor_penetration(p);
  note("floor_mm", depth);
  floor_worst_ = std::max(floor_worst_, depth);
  if (frame.scan) push_lowest(p, frame.scan->vertices);
  if (hands_) push_hands(p);
  if (penetration_ && frames_ % slow_every_ == 0) note("self_penetration", penetration_->share(p));
}

void Evaluator::push_lowest(const Points& vertices, const Points& scan) {
  const std::optional<float> target = lowest_height(vertices), source = lowest_height(scan);
  if (!target || !source) return;
  lowest_gaps_.push_back(1000.0 * static_cast<double>(std::abs(*target - *source)));
  last_["lowest_gap_mm"] = lowest_gaps_.back();
}

void Evaluator::push_hands(const Points& vertices) {
  const size_t t = frames_;
  contacts_.add(truth_->source_gaps[t], hands_->gaps(vertices));
  if (truth_->source_buried.empty()) return;
  const double buried = hands_->buried(vertices);
  note("arm_buried", buried);
  note("arm_buried_added", buried - static_cast<double>(truth_->source_buried[t]));
}

void Evaluator::push_bends(const Points& vertices, const Points& true_vertices) {
  const Rotations& local = truth_->rotations[frames_];
  for (size_t bend = 0; bend < BentVolume::kBends.size(); ++bend) {
    const Mat3& turn = local[BentVolume::kBends[bend]];
    if (geodesic_angle(turn, Mat3::Identity()) < kBent) continue;
    const double kept = bends_->kept(bend, vertices), should = bends_->kept(bend, true_vertices);
    if (!std::isfinite(kept) || !std::isfinite(should)) continue;
    note("bent_volume", kept);
    note("bent_volume_true", should);
  }
}

Metrics Evaluator::metrics() const {
  const bool gaps_alone = frames_ == 0 && !gaps_.empty();
  US_CHECK(frames_ > 0 || gaps_alone, "there are no frames to evaluate");
  US_CHECK(!truth_ || gaps_alone || frames_ == truth_->frames, "the source has ", frames_,
           " frames, the truth ", truth_ ? truth_->frames : 0);
  const auto of_surfaces = surface_figures();
  Metrics result;
  for (const Metric& metric : metric_table()) {
    const auto summed = of_surfaces.find(metric.key);
    const double value = metric.of && is_known(metric, seen_, true_) ? metric.of(seen_, true_, fps_)
                         : summed != of_surfaces.end() && (seen_.has_legs || !(metric.needs & kNeedsLegs))
                             ? summed->second
                             : std::nan("");
    if (std::isfinite(value)) result.emplace_back(metric.key, value);
  }
  return result;
}

std::map<std::string, double> Evaluator::surface_figures() const {
  std::map<std::string, double> figures = scene_.figures();
  figures.merge(gaps_.figures());
  for (const auto& [key, mean] : means_)
    if (mean.count > 0) figures[key] = mean.value();
  if (figures.count("floor_mm")) figures["floor_worst_mm"] = 1000 * floor_worst_;
  if (!lowest_gaps_.empty()) figures["lowest_gap_mm"] = percentile(lowest_gaps_, 50);
  const std::vector<PartFigures> parts = registered_.parts();
  if (!parts.empty()) {
    figures["registered_rot_deg"] = mean_rot_deg(parts);
    figures["registered_const_mm"] = mean_const_mm(parts);
  }
  if (contacts_.count() == 0) return figures;
  figures["hand_contacts"] = contacts_.count();
  figures["hand_contact_kept"] = contacts_.kept();
  figures["hand_contact_gap_mm"] = 1000 * contacts_.gap_m();
  return figures;
}

Metrics style_figures(const std::vector<Pose>& poses, const Joints& rest, double fps, bool has_legs) {
  MetricSequence seen;
  seen.has_style = true;
  seen.has_legs = has_legs;
  for (const Pose& pose : poses) {
    seen.joints.push_back(forward_kinematics(rest, pose).joints);
    seen.rotations.push_back(pose.local);
  }
  Metrics figures;
  for (const Metric& metric : metric_table()) {
    if (!(metric.needs & kNeedsStyle) || !is_known(metric, seen, {})) continue;
    const double value = metric.of(seen, {}, fps);
    if (std::isfinite(value)) figures.emplace_back(metric.key, value);
  }
  return figures;
}

double value_of(const Metrics& metrics, const std::string& key) {
  for (const auto& [name, value] : metrics)
    if (name == key) return value;
  return std::nan("");
}

void MeanMetrics::add(const std::string& key, double value) {
  const auto known =
      std::find_if(sums_.begin(), sums_.end(), [&](const auto& sum) { return sum.first == key; });
  const size_t at = known - sums_.begin();
  if (known == sums_.end()) sums_.emplace_back(key, 0), counts_.push_back(0);
  sums_[at].second += value;
  ++counts_[at];
}

Metrics MeanMetrics::means() const {
  Metrics means = sums_;
  for (size_t i = 0; i < means.size(); ++i) means[i].second /= counts_[i];
  return means;
}

Metrics mean_metrics(const std::vector<Metrics>& all) {
  MeanMetrics mean;
  for (const Metrics& one : all)
    for (const auto& [key, value] : one) mean.add(key, value);
  return mean.means();
}

}  // namespace understudy::app
