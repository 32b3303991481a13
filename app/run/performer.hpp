// Reads a source and lets a target perform it, frame by frame.
#pragma once

#include <optional>

#include "app/run/latency.hpp"
#include "app/run/source.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace understudy::app {

/// A frame that has been read and performed.
struct PerformedFrame {
  ScanFrame scan;  ///< metres, y up
  RetargetedFrame result;
  Joints source_joints;  ///< of the source, repaired and smoothed; of the last good frame where flagged
  FrameTimes times;
};

/// Reads and performs one frame after the other, and takes their times.
class Performer {
 public:
  Performer(Source& source, Target target, Networks networks, const RetargetOptions& options = {});
  /// None at the end of the source.
  std::optional<PerformedFrame> next();
  /// The same with the skeleton of the source known beforehand.
  std::optional<PerformedFrame> next(const Joints& oracle);
  /// The method forgets the past: the next frame is as a source's first.
  void restart() { retargeter_.restart(); }
  const Retargeter& retargeter() const { return retargeter_; }

 private:
  std::optional<PerformedFrame> next(const Extraction* oracle);

  Source& source_;
  Retargeter retargeter_;
  Joints last_seen_ = Joints::Zero();
};

}  // namespace understudy::app
