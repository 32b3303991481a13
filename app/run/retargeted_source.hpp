// Reads a source and retargets it, frame by frame.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>

#include "app/run/latency.hpp"
#include "app/run/person_cut.hpp"
#include "app/run/source.hpp"
#include "retarget/pipeline/retargeter.hpp"

namespace understudy::app {

/// What an observer sees in a source's frame: its scan, or the skeleton that it brings.
Observation observed(Observer& observer, const SourceFrame& frame, float dt);

/// Lets the retargeter's observer look at a source's first frame (Source::set_look); it must outlive the
/// source.
void look_with(Retargeter& retargeter, Source& source);

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
  /// `retargeter` starts anew, and looks at the source's first frame (look_with). Both must outlive this.
  /// `options` are those that the source was opened with: its `edits` are applied to each scan first, then
  /// the `person` is cut out.
  /// `tools` are the source's; the extractor is the retargeter's.
  RetargetedSource(Source& source, Retargeter& retargeter, const SourceOptions& options,
                   SourceTools tools = {});
  /// None at the end. Warns once of each limb that is not seen. known: the source's joints, where they are
  /// not to be extracted.
  std::optional<RetargetedFrame> next(const std::optional<Joints>& known = {});
  /// Who was seen so far.
  const PersonCut& cut() const { return cut_; }
  int64_t frames() const { return frames_; }
  int64_t flagged() const { return flagged_; }
  /// Frames in which each limb is seen whole, in the order of kFourLimbs.
  const std::array<int64_t, kFourLimbs.size()>& seen() const { return seen_; }
  /// At the end: warns, in one sentence that names the options,
  /// where no person is recognised in frames that have points.
  /// Throws Error naming the source where all frames are flagged.
  void check_used() const;

 private:
  bool read(const std::optional<Joints>& known);
  void count_limbs(const PerformedFrame& frame);

  Source& source_;
  Retargeter& retargeter_;
  std::string name_;
  ScanEdits edits_;  // none where scans are completed: they were applied before
  PersonCut cut_;
  std::string doubt_;                    // why the source may be no person; empty: nothing speaks against it
  std::string problem_;                  // of the first frame that could not be used
  std::deque<RetargetedFrame> waiting_;  // for their style
  bool ended_ = false;
  int64_t read_ = 0, frames_ = 0, flagged_ = 0, unrecognised_ = 0;
  std::array<int64_t, kFourLimbs.size()> seen_{};
  UnseenTold told_;
};

}  // namespace understudy::app
