// The playhead: which frame is shown, and how time moves it.
#pragma once

#include <set>

#include "retarget/base/fields.hpp"

namespace understudy::app {

struct Playback {
  bool playing = false;
  bool loop = true;
  bool live = true;       ///< while frames are being made the newest is shown, until the user seeks
  double rate = 1;        ///< 0.1 .. 4
  double frame = 0;       ///< fractional while playing; shown_frame() is what is seen
  int in = -1, out = -1;  ///< loop marks, both inside; -1: from the first, to the last
};
template <class V, class S>
FieldsOf<S, Playback> fields(V& visit, S& playback) {
  visit("loop", playback.loop);
  visit("rate", playback.rate, Clamped<double>{0.1, 4});
  visit("frame", playback.frame, Clamped<double>{0, kFrameNumbers.high});
  visit("in", playback.in, Clamped<int>{-1, kFrameNumbers.high});
  visit("out", playback.out, Clamped<int>{-1, kFrameNumbers.high});
}

/// The range that plays: the marks, or all of the `count` frames.
struct FrameRange {
  int first = 0, last = -1;
  bool empty() const { return last < first; }
};
FrameRange play_range(const Playback& playback, int count);
/// The frame to show, -1 when there is none.
int shown_frame(const Playback& playback, int count);
/// Advances by `seconds`, leaving out the `skipped` frames. Loops or stops at the end.
void advance(Playback& playback, double seconds, double fps, int count, const std::set<int>& skipped);

}  // namespace understudy::app
