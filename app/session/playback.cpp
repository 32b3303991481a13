#include "app/session/playback.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::app {

FrameRange play_range(const Playback& playback, int count) {
  FrameRange range{0, count - 1};
  if (playback.in >= 0) range.first = std::min(playback.in, range.last);
  if (playback.out >= 0) range.last = std::min(playback.out, range.last);
  if (range.last < range.first) range.first = range.last;
  return count > 0 ? range : FrameRange{};
}

int shown_frame(const Playback& playback, int count) {
  if (count <= 0) return -1;
  return std::clamp(static_cast<int>(std::floor(playback.frame + 1e-6)), 0, count - 1);
}

namespace {

/// The first frame from `frame` on, inside the range, that is not skipped; the range's first when all are.
double next_kept(double frame, const FrameRange& range, const std::set<int>& skipped) {
  int whole = static_cast<int>(std::floor(frame));
  if (skipped.count(whole) == 0) return frame;
  while (whole <= range.last && skipped.count(whole)) ++whole;
  return whole;
}

}  // namespace

void advance(Playback& playback, double seconds, double fps, int count, const std::set<int>& skipped) {
  const FrameRange range = play_range(playback, count);
  if (!playback.playing || range.empty()) return;
  const double length = range.last - range.first + 1;
  double frame = std::max<double>(playback.frame, range.first) + seconds * fps * playback.rate;
  frame = next_kept(frame, range, skipped);
  if (frame >= range.last + 1) {
    if (!playback.loop) {
      playback.playing = false;
      playback.frame = range.last;
      return;
    }
    frame = range.first + std::fmod(frame - range.first, length);
    frame = next_kept(frame, range, skipped);
    if (frame >= range.last + 1) frame = range.first;
  }
  playback.frame = frame;
}

}  // namespace understudy::app
