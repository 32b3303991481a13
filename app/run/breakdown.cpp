#include "app/run/breakdown.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/confidence.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::app {
namespace {

constexpr int64_t kApart = 10;  // frames between two of the worst

/// BODY of a case BODY_MOTION.
std::string body_of(const Case& c, const std::string& motion) {
  const std::string end = "_" + motion;
  return c.name.size() > end.size() && ends_with(c.name, end) ? c.name.substr(0, c.name.size() - end.size())
                                                              : c.name;
}

Json names_of(const FrameFailures& failures) {
  Json names = Json::array();
  for (int f = 0; f < kFailureCount; ++f)
    if (failures[f]) names.push_back(kFailureNames[f]);
  return names;
}

Json groups(const std::map<std::string, std::vector<Metrics>>& by_name) {
  Json json = Json::object();
  for (const auto& [name, metrics] : by_name) json[name] = to_json(mean_metrics(metrics));
  return json;
}

}  // namespace

void Breakdown::add(const std::string& folder, const Case& c, const Evaluator& evaluator,
                    const Truth& truth) {
  const std::string motion = c.tags.empty() ? c.name : c.tags.back();
  motions_[motion].push_back(evaluator.metrics());
  bodies_[body_of(c, motion)].push_back(evaluator.metrics());
  add_joints(evaluator, truth);
  add_confidence(evaluator, truth);
  const auto failures = failures_of({evaluator.source_joints(), truth.source_joints, evaluator.joints(),
                                     truth.joints, evaluator.rotations(), truth.rotations, c.fps});
  const bool seen = !evaluator.source_joints().empty() && !truth.source_joints.empty(),
             performed = !evaluator.joints().empty() && !truth.joints.empty(),
             turned = !evaluator.rotations().empty() && !truth.rotations.empty();
  const std::array<bool, kFailureCount> evaluated = {seen, seen, seen, seen || performed, performed, turned};
  for (const FrameFailures& frame : failures) {
    for (int f = 0; f < kFailureCount; ++f) {
      evaluated_[f] += evaluated[f];
      failures_[f] += frame[f];
      motion_failures_[motion][f] += frame[f];
    }
  }
  if (seen) add_worst(folder, c, evaluator, truth, failures);
}

void Breakdown::add_worst(const std::string& folder, const Case& c, const Evaluator& evaluator,
                          const Truth& truth, const std::vector<FrameFailures>& failures) {
  const auto worse = [](const WorstFrame& a, const WorstFrame& b) { return a.error_m > b.error_m; };
  std::vector<WorstFrame> frames;
  for (size_t t = 0; t < failures.size(); ++t) {
    const Joints &seen = evaluator.source_joints()[t], &known = truth.source_joints[t];
    frames.push_back({folder, c.name, static_cast<int64_t>(t), mean_joint_error({seen}, {known}), seen, known,
                      failures[t]});
  }
  std::stable_sort(frames.begin(), frames.end(), worse);
  std::vector<WorstFrame> chosen;  // of this case, far enough apart
  for (const WorstFrame& frame : frames) {
    if (chosen.size() >= keep_) break;
    const auto near = [&](const WorstFrame& other) { return std::abs(other.frame - frame.frame) < kApart; };
    if (std::none_of(chosen.begin(), chosen.end(), near)) chosen.push_back(frame);
  }
  worst_.insert(worst_.end(), chosen.begin(), chosen.end());
  std::stable_sort(worst_.begin(), worst_.end(), worse);
  if (worst_.size() > keep_) worst_.resize(keep_);
}

void Breakdown::add_joints(const Evaluator& evaluator, const Truth& truth) {
  const auto distances = [this](const char* key, const JointSequence& p, const JointSequence& q) {
    if (p.empty() || q.empty()) return;
    for (size_t t = 0; t < p.size(); ++t)
      for (int j = 0; j < kJointCount; ++j) joints_[j].add(key, 1000 * (p[t].row(j) - q[t].row(j)).norm());
  };
  distances("extraction_mm", evaluator.source_joints(), truth.source_joints);
  distances("mpjpe_mm", evaluator.joints(), truth.joints);
  if (!evaluator.joints().empty() && !truth.joints.empty())
    distances("pa_mpjpe_mm", aligned_joints(evaluator.joints(), truth.joints), truth.joints);
  if (evaluator.rotations().empty() || truth.rotations.empty()) return;
  for (size_t t = 0; t < truth.rotations.size(); ++t) {
    const Rotations p = global_rotations(evaluator.rotations()[t]), q = global_rotations(truth.rotations[t]);
    for (int j = 0; j < kJointCount; ++j) joints_[j].add("rot_deg", geodesic_angle(p[j], q[j]) * 180 / kPi);
  }
}

void Breakdown::add_confidence(const Evaluator& evaluator, const Truth& truth) {
  if (evaluator.confidence().empty() || evaluator.raw_joints().empty() || truth.source_joints.empty()) return;
  for (size_t t = 0; t < evaluator.confidence().size(); ++t) {
    const Joints &seen = evaluator.raw_joints()[t], &known = truth.source_joints[t];
    for (int j = 0; j < kJointCount; ++j) {
      confidence_.confidence.push_back(evaluator.confidence()[t][j]);
      confidence_.error.push_back((seen.row(j) - known.row(j)).norm());
    }
    confidence_.frame_confidence.push_back(evaluator.confidence()[t].mean());
    confidence_.frame_error.push_back(mean_joint_error({seen}, {known}));
  }
}

void ConfidenceRecord::append(const ConfidenceRecord& other) {
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(confidence, other.confidence);
  add(error, other.error);
  add(frame_confidence, other.frame_confidence);
  add(frame_error, other.frame_error);
}

/// Correlations of the confidence with nearness: 1 when the more confident is always the nearer.
Json ConfidenceRecord::figures() const {
  std::vector<double> expected;
  for (const double c : confidence) expected.push_back(expected_error_for(static_cast<float>(c)));
  Json json = {{"rank_correlation", -rank_correlation(confidence, error)},
               {"best_rank_correlation", best_rank_correlation(expected)},
               {"frame_rank_correlation", -rank_correlation(frame_confidence, frame_error)}};
  json["bins"] = Json::array();
  for (const ReliabilityBin& bin : reliability(confidence, error))
    json["bins"].push_back({{"confidence", bin.confidence},
                            {"expected_mm", 1000 * expected_error_for(static_cast<float>(bin.confidence))},
                            {"error_mm", 1000 * bin.error},
                            {"p90_mm", 1000 * bin.p90},
                            {"count", bin.count}});
  return json;
}

Json to_json(const ConfidenceRecord& record) {
  return {{"confidence", record.confidence},
          {"error", record.error},
          {"frame_confidence", record.frame_confidence},
          {"frame_error", record.frame_error}};
}

ConfidenceRecord confidence_record(const Json& json) {
  return {json.at("confidence"), json.at("error"), json.at("frame_confidence"), json.at("frame_error")};
}

Json Breakdown::json() const {
  Json json = {{"joints", Json::object()}, {"motions", groups(motions_)}, {"bodies", groups(bodies_)}};
  for (int j = 0; j < kJointCount; ++j)
    if (const Metrics means = joints_[j].means(); !means.empty())
      json["joints"][kJointNames[j]] = to_json(means);
  for (int f = 0; f < kFailureCount; ++f) {
    Json& failure = json["failures"][kFailureNames[f]];
    failure["evaluated"] = evaluated_[f];
    failure["frames"] = failures_[f];
    failure["share"] =
        static_cast<double>(failures_[f]) / static_cast<double>(std::max<int64_t>(evaluated_[f], 1));
    for (const auto& [motion, counts] : motion_failures_)
      if (counts[f] > 0) failure["motions"][motion] = counts[f];
  }
  if (!kinds_.empty()) json["kinds"] = groups(kinds_);
  if (!confidence_.confidence.empty()) json["confidence"] = confidence_.figures();
  json["worst"] = Json::array();
  for (const WorstFrame& w : worst_)
    json["worst"].push_back({{"case", w.case_name},
                             {"frame", w.frame},
                             {"error_mm", 1000 * w.error_m},
                             {"failures", names_of(w.failures)}});
  return json;
}

}  // namespace understudy::app
