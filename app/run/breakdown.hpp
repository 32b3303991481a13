// Where the error of an evaluation lies: by joint, motion and body, by kind of failure, by frame; and whether
// the extractor's confidence shows it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/run/case_folder.hpp"
#include "app/run/report.hpp"
#include "retarget/metrics/failures.hpp"

namespace understudy::app {

/// A frame in which the source's skeleton was seen badly.
struct WorstFrame {
  std::string case_folder, case_name;
  int64_t frame = 0;
  double error_m = 0;  ///< mean over joints of what was seen
  Joints seen, truth;
  FrameFailures failures{};
};

/// Confidence and error of an extractor: of joints, and of frames (the means of their joints). Metres.
struct ConfidenceRecord {
  std::vector<double> confidence, error, frame_confidence, frame_error;
  void append(const ConfidenceRecord& other);
  /// {"rank_correlation", "best_rank_correlation", "frame_rank_correlation", "bins": [{"confidence",
  /// "expected_mm", "error_mm", "p90_mm", "count"}]}
  Json figures() const;
};
/// The lists themselves, as report keeps them. Throws nlohmann's exceptions where the JSON is another.
Json to_json(const ConfidenceRecord& record);
ConfidenceRecord confidence_record(const Json& json);

/// Collects evaluated cases.
class Breakdown {
 public:
  explicit Breakdown(size_t worst = 20) : keep_(worst) {}
  /// A case with its truth, after all of its frames were evaluated. `folder` is the case's. Cases named
  /// BODY_MOTION, the motion being the last tag, count for both.
  void add(const std::string& folder, const Case& c, const Evaluator& evaluator, const Truth& truth);
  /// Figures of a case whose body is of some kind: its rig was found.
  void add_kind(const std::string& kind, const Metrics& metrics) { kinds_[kind].push_back(metrics); }
  /// {"joints": {"left_hip": {figures}}, "motions": {"walk": {figures}}, "bodies": {...}, "failures":
  /// {"jolt": {"evaluated", "frames", "share"}}, "confidence": ConfidenceRecord::figures(), "worst": [...],
  /// "kinds": {"hand": {figures}}}; without what is unknown.
  Json json() const;
  const ConfidenceRecord& confidence() const { return confidence_; }
  /// The worst first; those of one case are at least ten frames apart.
  const std::vector<WorstFrame>& worst() const { return worst_; }

 private:
  void add_worst(const std::string& folder, const Case& c, const Evaluator& evaluator, const Truth& truth,
                 const std::vector<FrameFailures>& failures);
  void add_joints(const Evaluator& evaluator, const Truth& truth);
  void add_confidence(const Evaluator& evaluator, const Truth& truth);

  size_t keep_;
  std::array<MeanMetrics, kJointCount> joints_;
  std::map<std::string, std::vector<Metrics>> motions_, bodies_, kinds_;
  std::map<std::string, std::array<int64_t, kFailureCount>> motion_failures_;
  std::array<int64_t, kFailureCount> failures_{}, evaluated_{};  // frames with it, and looked at for it
  ConfidenceRecord confidence_;
  std::vector<WorstFrame> worst_;
};

}  // namespace understudy::app
