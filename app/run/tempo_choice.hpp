// --tempo and --delay: when the frames of a result are shown, as they are made.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "retarget/editing/tempo_edit.hpp"
#include "retarget/pipeline/performer.hpp"
#include "retarget/pipeline/running_median.hpp"

namespace understudy::app {

/// What is asked for.
struct TempoChoice {
  std::string tempo;   ///< "body", "off", or how many times as long the result lasts; empty: off
  double delay_s = 0;  ///< above 0: as many frames come out as go in, see LiveTempo
  bool any() const { return !tempo.empty() && tempo != "off"; }
};
/// Throws Error where the word is none of these, or a delay is asked of what has no tempo.
void check(const TempoChoice& choice);

/// Gives what is performed its tempo, frame by frame. Without one each frame passes as it is.
class TempoStream {
 public:
  /// rest: the target's T-pose joints.
  TempoStream(const TempoChoice& choice, const Joints& rest, double fps);
  /// What is shown for this frame, one after the other: none, one, or several.
  std::vector<PerformedFrame> push(const PerformedFrame& frame);
  /// What is left after the last one.
  std::vector<PerformedFrame> finish();
  /// How many times as long the result lasts by now; 1 where a delay keeps its length.
  double length() const { return live_ ? 1 : wanted_length(); }

 private:
  double wanted_length() const;
  PerformedFrame between(const PerformedFrame& before, const PerformedFrame& after, float share) const;
  PerformedFrame shown(float behind_s) const;

  TempoChoice choice_;
  Joints rest_;
  double step_;
  RunningMedian leg_source_;
  std::optional<LiveTempo> live_;
  std::deque<PerformedFrame> last_;  // the last one; with a delay those that are still to be shown
  double at_ = 0;                    // moment of the last frame in the result, seconds
  int64_t out_ = 0;                  // frames
};

}  // namespace understudy::app
