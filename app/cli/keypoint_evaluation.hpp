// Judges whether a network's keypoints are the same in all sequences of a kind.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/evaluation.hpp"
#include "retarget/metrics/rig_metrics.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"

namespace understudy::app {

class KeypointEvaluation {
 public:
  /// What finds rigs by the network of that kind; it notes what it has found. Throws Error as
  /// nn::load_keypoint_finder.
  RigFinder finder(const EvalOptions& options, const std::string& kind);
  /// Judges what the kind's finder has noted last against the truth of these scans. Nothing where there is no
  /// such finder.
  void add(const std::string& kind, const RigTruth& truth);
  /// By kinds: sc (paper 3, eq. 21) of the network's keypoints, how many they are, how many of these are not
  /// faint on the mean, and frames. Null where nothing was noted.
  Json summary() const;

 private:
  struct Kind {
    std::shared_ptr<KeypointFinder> network;
    std::vector<Points> keypoints;  // of the last sequence, a frame each
    SemanticConsistency sc;
    int64_t frames = 0, bright = 0;
  };
  std::map<std::string, Kind> kinds_;
};

}  // namespace understudy::app
