// The timeline: transport, and a track with what has been made, bad frames, loop marks and a metric.
// Marks: timeline.first, .back, .play, .forward, .last, .loop, .in, .out, .clear_marks, .live, .rate,
// .metric, .steps, .frame, .time; timeline.track and what timeline_track() marks in it (bands left_foot,
// right_foot).
#pragma once

#include <cstdint>
#include <vector>

#include "ui/panels/panel.hpp"
#include "ui/widgets/timeline_track.hpp"

namespace understudy::ui {

/// Runs of frames in which the left and the right foot of the selected take are held on the floor.
struct StandingRuns {
  std::vector<LoopRange> of_foot[2];

  /// Updates it from the session; only frames that are new or changed are looked at.
  void follow(const app::Session& session);

 private:
  int take_ = -1;
  int64_t generation_ = -1;
  size_t frames_ = 0;  // looked at
};

/// Where the selected take begins a step: "L" with the left foot, "R" with the right.
struct StepLetters {
  std::vector<TrackLetter> letters;

  /// Updates it from the session: once all frames that are to be looked at are there.
  void follow(const app::Session& session);

 private:
  int take_ = -1;
  int64_t generation_ = -1;
  size_t frames_ = 0;  // looked at
};

/// Values that are costly to find and change rarely.
struct TimelineState {
  int64_t generation = -1;  ///< of the source that the rest is about
  bool looked = false;
  size_t frames = 0;  ///< of the source when bad ones were looked for
  std::vector<app::BadFrame> bad;
  std::vector<int> bad_numbers;
  std::vector<float> confidence;  ///< of the source, a value a frame
  struct Fill {
    int first = 0, last = 0;
    std::string why;
  };
  std::vector<Fill> fills;  ///< runs of frames without a pose of their own: the last good one fills them
  StandingRuns standing;
  StepLetters steps;
  std::shared_ptr<const DiscoveredRig> rig;  ///< that what follows is of
  std::vector<float> bones_off_mm;           ///< of found bones from the scans, a value a frame; empty: none
  std::vector<LoopRange> doubted;            ///< frames in which they are not to be trusted

  /// Updates it from the session.
  void follow(const app::Session& session);
  /// Why a frame is bad; "" where it is not.
  std::string why(int frame) const;

 private:
  void follow_bones(const app::Session& session);
};

/// The channel that the hand edits: three values a frame of the selected joint, while a tool for joints or
/// bones is taken.
struct Channel {
  std::string label;  ///< "Left elbow: rotation about x, y, z, °"; empty: there is none
  std::vector<float> values[3];
  std::vector<int> keys;  ///< frames with edits of this joint

  /// Updates it from the session; only frames that are new or changed are looked at.
  void follow(const app::Session& session);

 private:
  std::vector<int64_t> about_;  // what the values are of
};

/// An edit as the timeline shows it, and the commands that move and remove it.
struct EditMark {
  TrackMark mark;
  app::Arguments move;  ///< of edit.move, without the frames that it is to have
  std::string remove;   ///< a command with its arguments, as a line of a script
};
/// All edits over time of the source and of the selected take: people put right, dragged joints, exchanged
/// ranges and frames that stand still in row 0, rotated bones, fills and skips in row 1.
std::vector<EditMark> edit_marks(const app::Session& session, const std::vector<TimelineState::Fill>& fills);

/// In which frames of the selected take each foot is held on the floor: two bands, left and right; none where
/// no foot ever is.
std::vector<TrackBand> contact_bands(const app::Session& session, const StandingRuns& standing);

/// Heights at scale 1: with the track, and the transport alone.
constexpr float kTimelineHeight = 152, kShortTimelineHeight = 102, kTransportHeight = 44;

}  // namespace understudy::ui
