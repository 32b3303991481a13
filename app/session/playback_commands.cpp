#include <algorithm>

#include "app/session/command_sets.hpp"

namespace understudy::app {
namespace {

/// Moves the playhead to a frame and stops following the newest one.
void go_to(Session& session, double frame) {
  session.playback.frame = std::clamp(frame, 0.0, std::max(0.0, frame_count(session) - 1.0));
  session.playback.live = false;
}

void play(Session& session, bool playing) {
  Playback& playback = session.playback;
  const FrameRange range = play_range(playback, frame_count(session));
  if (playing && !range.empty() && shown_frame(session) >= range.last) playback.frame = range.first;
  playback.playing = playing;
  if (playing) playback.live = false;
}

/// The mark at the frame given, or at the one shown.
int mark(const Session& session, const Arguments& arguments) {
  return arguments.empty() ? shown_frame(session) : whole_number(arguments, 0, "frame");
}

void add_transport(Commands& commands) {
  commands.add({"playback.toggle", "Play / pause", "", "Space", false, false,
                [](Studio& s, const Arguments&) { play(s.session(), !s.session().playback.playing); }});
  commands.add({"playback.play", "Play", "", "", false, false,
                [](Studio& s, const Arguments&) { play(s.session(), true); }});
  commands.add({"playback.pause", "Pause", "", "", false, false,
                [](Studio& s, const Arguments&) { play(s.session(), false); }});
  commands.add({"playback.step", "Step", "N: frames forward; negative: back", "", false, false,
                [](Studio& s, const Arguments& a) {
                  Session& session = s.session();
                  session.playback.playing = false;
                  go_to(session, shown_frame(session) + whole_number(a, 0, "number of frames"));
                }});
  commands.add({"playback.step_on", "Next frame", "", "Right", false, false,
                [](Studio& s, const Arguments&) { s.run("playback.step", {"1"}); }});
  commands.add({"playback.step_back", "Previous frame", "", "Left", false, false,
                [](Studio& s, const Arguments&) { s.run("playback.step", {"-1"}); }});
  commands.add({"playback.first", "First frame", "", "Home", false, false, [](Studio& s, const Arguments&) {
                  go_to(s.session(), play_range(s.session().playback, frame_count(s.session())).first);
                }});
  commands.add({"playback.last", "Last frame", "", "End", false, false, [](Studio& s, const Arguments&) {
                  go_to(s.session(), play_range(s.session().playback, frame_count(s.session())).last);
                }});
}

void add_seeking(Commands& commands) {
  commands.add({"playback.frame", "Go to frame", "FRAME", "", false, false,
                [](Studio& s, const Arguments& a) { go_to(s.session(), number(a, 0, "frame")); }});
  commands.add({"playback.seek", "Seek", "SECONDS: jumps to a time", "", false, false,
                [](Studio& s, const Arguments& a) {
                  go_to(s.session(), number(a, 0, "time") * s.session().source.fps);
                }});
  commands.add(
      {"playback.rate", "Rate", "FACTOR: 0.1 to 4", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().playback.rate = std::clamp(number(a, 0, "rate"), 0.1, 4.0);
       }});
  commands.add(
      {"playback.loop", "Loop", "on|off|toggle", "L", false, false, [](Studio& s, const Arguments& a) {
         s.session().playback.loop = switched(a, 0, s.session().playback.loop);
       }});
  commands.add({"playback.in", "Loop from here", "[FRAME]", "I", false, false,
                [](Studio& s, const Arguments& a) { s.session().playback.in = mark(s.session(), a); }});
  commands.add({"playback.out", "Loop to here", "[FRAME]", "O", false, false,
                [](Studio& s, const Arguments& a) { s.session().playback.out = mark(s.session(), a); }});
  commands.add(
      {"playback.clear_marks", "Clear the loop marks", "", "Shift+I", false, false,
       [](Studio& s, const Arguments&) { s.session().playback.in = s.session().playback.out = -1; }});
  commands.add({"playback.follow_live", "Follow the newest frame", "", "", false, false,
                [](Studio& s, const Arguments&) {
                  s.session().playback.live = true;
                  s.session().playback.playing = false;
                }});
}

}  // namespace

void add_playback_commands(Commands& commands) {
  add_transport(commands);
  add_seeking(commands);
}

}  // namespace understudy::app
