// The timeline: transport, and a track with what has been made, bad frames, loop marks and a metric.
// Marks: timeline.first, .back, .play, .forward, .last, .loop, .in, .out, .clear_marks, .live, .rate,
// .metric, .frame, .time; timeline.track and what timeline_track() marks in it.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/panels/panel.hpp"

namespace understudy::ui {

/// Values that are costly to find and change rarely.
struct TimelineState {
  int64_t generation = -1;  ///< of the source that the rest is about
  bool looked = false;
  size_t frames = 0;  ///< of the source when bad ones were looked for
  std::vector<app::BadFrame> bad;
  std::vector<int> bad_numbers;
  std::vector<float> confidence;  ///< of the source, a value a frame

  /// Updates it from the session.
  void follow(const app::Session& session);
  /// Why a frame is bad; "" where it is not.
  std::string why(int frame) const;
};

/// Heights at scale 1: with the track, and the transport alone.
constexpr float kTimelineHeight = 128, kTransportHeight = 44;

}  // namespace understudy::ui
