#include "app/studio/recorder.hpp"

#include <algorithm>
#include <cmath>

#include "app/studio/event_text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::app {

using EventKind = render::InputEvent::Kind;

Recorder::Recorder(const std::string& path, Application& application) : path_(path) {
  check_writable(path);
  file_.open(path);
  US_CHECK(file_, path, ": the recording cannot be written");
  const render::PixelSize size = application.surface().target().size;
  const Settings& settings = application.session().settings;
  const float scale = settings.scale > 0 ? settings.scale : application.surface().content_scale();
  write("# A recording: understudy play " + path);
  write("resize " + std::to_string(size.width) + " " + std::to_string(size.height));
  write(std::string("settings.theme ") + (settings.dark ? "dark" : "light"));
  write("settings.scale " + std::to_string(scale));
}

void Recorder::write(const std::string& line) {
  file_ << line << '\n' << std::flush;  // a crash leaves all that led to it
  US_CHECK(file_, path_, ": the recording cannot be written");
}

void Recorder::input(double dt, const std::vector<render::InputEvent>& events, const Session& session) {
  waited_s_ += dt;
  if (events.empty()) return;
  const int made = frame_count(session);
  if (made != made_ && made > 0) write("wait_frames " + std::to_string(made));
  if (!session.working && !idle_) write("wait");
  made_ = made;
  idle_ = !session.working;
  const int frames = std::clamp(static_cast<int>(std::lround(waited_s_ * 60)), 1, 120);
  write("frames " + std::to_string(frames));
  waited_s_ = 0;
  for (const render::InputEvent& event : events) {
    if (event.kind == EventKind::Resize)
      write("resize " + std::to_string(event.width) + " " + std::to_string(event.height));
    else if (event.kind == EventKind::Close)
      write("close");
    else
      write(join_line("event", event_words(event)));
  }
}

void Recorder::command(const std::string& name, const Arguments& arguments) {
  write("# -> " + join_line(name, arguments));
}

void Recorder::opened(const std::string& name, const Arguments& arguments) {
  write(join_line(name, arguments));
}

}  // namespace understudy::app
