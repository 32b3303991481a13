// Sends performed frames to engines as they are made.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/formats/scan_source.hpp"
#include "retarget/live/pose_sender.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy::app {

struct PoseOutputOptions {
  std::vector<std::string> addresses;  ///< see PoseSender
  double fps = 30;
  bool in_time = false;  ///< each frame is held back until its time: the source is there as a whole
};

/// Where the source is lost for some seconds the target blends to its T-pose (TPoseBlend). One thread at a
/// time.
class PoseOutput {
 public:
  /// Throws Error naming an address that is none.
  PoseOutput(const PoseOutputOptions& options, const Target& target);
  /// live: what the frame was made of; none: a file's, or nothing came.
  void push(const PerformedFrame& frame, const std::optional<LiveMoment>& live);

 private:
  PoseOutputOptions options_;
  Joints rest_;
  TPoseBlend blend_;
  std::vector<PoseSender> senders_;
  std::chrono::steady_clock::time_point start_{};
  int64_t frames_ = 0;
};

/// Of a target that stands on its soles: its pelvis' height, metres.
float hip_height_of(const Target& target);

}  // namespace understudy::app
