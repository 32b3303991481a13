#include <algorithm>

#include "app/session/command_sets.hpp"

namespace understudy::app {
namespace {

/// Moves the playhead to a frame and stops following the newest one.
void go_to(Session& session, double frame) {
  session.playback.frame = std::clamp(frame, 0.0, std::max(0.0, frame_count(session) - 1.0));
  session.playback.live = false;
}

/// What plays.
FrameRange range(const Session& session) {
  return play_range(session.playback, frame_count(session));
}

void play(Session& session, bool playing) {
  Playback& playback = session.playback;
  const FrameRange plays = range(session);
  if (playing && !plays.empty() && shown_frame(session) >= plays.last) playback.frame = plays.first;
  playback.playing = playing;
  if (playing) playback.live = false;
}

/// The mark at the frame given, or at the one shown.
int mark(const Call& c) {
  return c.arguments.empty() ? shown_frame(c.session) : c.number<int>(0, "frame");
}

void add_transport(Commands& commands) {
  commands.add({"playback.toggle", "Play / pause", "", "Space"},
               [](Call& c) { play(c.session, !c.session.playback.playing); });
  commands.add({"playback.play", "Play"}, [](Call& c) { play(c.session, true); });
  commands.add({"playback.pause", "Pause"}, [](Call& c) { play(c.session, false); });
  commands.add({"playback.step", "Step", "N: frames forward; negative: back"}, [](Call& c) {
    c.session.playback.playing = false;
    go_to(c.session, shown_frame(c.session) + c.number<int>(0, "number of frames"));
  });
  commands.add({"playback.step_on", "Next frame", "", "Right"},
               [](Call& c) { c.studio.run("playback.step", {"1"}); });
  commands.add({"playback.step_back", "Previous frame", "", "Left"},
               [](Call& c) { c.studio.run("playback.step", {"-1"}); });
  commands.add({"playback.first", "First frame", "", "Home"},
               [](Call& c) { go_to(c.session, range(c.session).first); });
  commands.add({"playback.last", "Last frame", "", "End"},
               [](Call& c) { go_to(c.session, range(c.session).last); });
}

void add_seeking(Commands& commands) {
  commands.add({"playback.frame", "Go to frame", "FRAME"},
               [](Call& c) { go_to(c.session, c.number<double>(0, "frame")); });
  commands.add({"playback.seek", "Seek", "SECONDS: jumps to a time, at the tempo of the current take"},
               [](Call& c) { go_to(c.session, frame_at(c.session, c.number<double>(0, "time"))); });
  commands.add({"playback.rate", "Rate", "FACTOR: 0.1 to 4"},
               [](Call& c) { c.session.playback.rate = c.clamped(0, "rate", 0.1, 4.0); });
  commands.add({"playback.loop", "Loop", "on|off|toggle", "L"},
               [](Call& c) { c.session.playback.loop = c.switched(0, c.session.playback.loop); });
  commands.add({"playback.in", "Loop from here", "[FRAME]", "I"},
               [](Call& c) { c.session.playback.in = mark(c); });
  commands.add({"playback.out", "Loop to here", "[FRAME]", "O"},
               [](Call& c) { c.session.playback.out = mark(c); });
  commands.add({"playback.clear_marks", "Clear the loop marks", "", "Shift+I"},
               [](Call& c) { c.session.playback.in = c.session.playback.out = -1; });
  commands.add({"playback.follow_live", "Follow the newest frame"}, [](Call& c) {
    c.session.playback.live = true;
    c.session.playback.playing = false;
  });
}

}  // namespace

void add_playback_commands(Commands& commands) {
  add_transport(commands);
  add_seeking(commands);
}

}  // namespace understudy::app
