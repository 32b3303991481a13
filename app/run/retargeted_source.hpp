// Reads a source and retargets it, frame by frame.
#pragma once

#include <optional>
#include <string>

#include "app/run/latency.hpp"
#include "app/run/source.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace understudy::app {

/// What an observer sees in a source's frame: its scan, or the skeleton that it brings.
Observation observed(Observer& observer, const SourceFrame& frame, float dt);

/// A frame that has been read and performed.
struct RetargetedFrame {
  int64_t index = 0;  ///< 0 the first
  SourceFrame scan;   ///< metres, y up
  PerformedFrame result;
  FrameTimes times;
};

/// Goes through a source once, counts its frames and takes their times.
class RetargetedSource {
 public:
  /// `retargeter` starts anew. Both must outlive this. name: for people.
  /// `edits` are applied to each scan first.
  RetargetedSource(Source& source, Retargeter& retargeter, std::string name, ScanEdits edits = {});
  /// None at the end. known: the source's joints, where they are not to be extracted.
  std::optional<RetargetedFrame> next(const std::optional<Joints>& known = {});
  int64_t frames() const { return frames_; }
  int64_t flagged() const { return flagged_; }
  /// At the end: warns, in one sentence that names the options,
  /// where no person is recognised in frames that have points.
  /// Throws Error naming the source where all frames are flagged.
  void check_used() const;

 private:
  Source& source_;
  Retargeter& retargeter_;
  std::string name_;
  ScanEdits edits_;
  std::string doubt_;  // why the source may be no person; empty: nothing speaks against it
  int64_t frames_ = 0, flagged_ = 0, unrecognised_ = 0;
};

}  // namespace understudy::app
