#include "app/studio/window_commands.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "app/session/command_sets.hpp"
#include "app/studio/study_render.hpp"
#include "render/context/context.hpp"
#include "render/image.hpp"
#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/pose_edits.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/picture.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestPicture = 16384;  // pixels a side
constexpr int64_t kCacheMb = 128;       // of frames, for a job

struct Saving {
  std::string path;
  ui::PictureOptions options;
};

/// Draws what a session shows apart from the window, on the thread of a job: with a context, a cache and a
/// copy of the session of its own.
class Stage {
 public:
  Stage(Session session, const Saving& saving)
      : session_(std::move(session)),
        options_(saving.options),
        cache_(kCacheMb),
        context_(render::make_offscreen_context()) {
    SourceOptions source = source_as_read(session_);
    source.quiet = true;
    cache_.set_source(source, session_.document.scan_edits);
    session_.playback.playing = session_.playback.live = false;
  }
  render::Image picture(int frame) {
    session_.playback.frame = frame;
    return maker_.picture(session_, cache_, options_);
  }

 private:
  Session session_;
  ui::PictureOptions options_;
  FrameCache cache_;
  std::unique_ptr<render::Context> context_;
  ui::PictureMaker maker_;
};

std::optional<int> whole(const std::string& text) {
  int64_t value = 0;
  if (!parse_integer(text, value)) return std::nullopt;
  return static_cast<int>(std::clamp<int64_t>(value, -1, 1 << 20));
}

/// PATH [WIDTH HEIGHT] [transparent] [view|all].
Saving saving_of(const Call& c) {
  const Arguments& arguments = c.arguments;
  US_CHECK(!c.word(0, "path").empty(), "a path is missing");
  Saving saving;
  saving.path = c.path(0);
  for (size_t i = 1; i < arguments.size(); ++i) {
    const auto width = whole(arguments[i]);
    const auto height = i + 1 < arguments.size() ? whole(arguments[i + 1]) : std::nullopt;
    if (width && height) {
      saving.options.size = {*width, *height};
      ++i;
    } else if (arguments[i] == "transparent") {
      saving.options.transparent = true;
    } else {
      US_CHECK(arguments[i] == "view" || arguments[i] == "all", arguments[i],
               " is not understood: PATH [WIDTH HEIGHT] [transparent] [view|all]");
      saving.options.pane = arguments[i] == "all" ? -1 : c.session.view.active_pane;
    }
  }
  const auto [width, height] = std::pair(saving.options.size.width, saving.options.size.height);
  US_CHECK(width >= 16 && height >= 16 && width <= kLargestPicture && height <= kLargestPicture,
           "a picture of ", width, " x ", height, " pixels cannot be made: 16 to ", kLargestPicture,
           " a side");
  return saving;
}

/// What the job's thread may look at.
std::shared_ptr<Session> copied(const Session& of) {
  auto session = std::make_shared<Session>(of);
  session->history.clear();
  session->log.clear();
  return session;
}

void save_picture(Call& c) {
  const Saving saving = saving_of(c);
  const int frame = shown_frame(c.session);
  US_CHECK(frame >= 0, "there is nothing to show yet");
  remember_folder(c.studio, saving.path);
  c.studio.jobs().start(
      "Saving " + file_name(saving.path),
      [saving, frame, session = copied(c.session)](JobControl&) {
        Stage stage(std::move(*session), saving);
        render::write_png(saving.path, stage.picture(frame));
      },
      [&studio = c.studio, saving] {
        studio.notify("Saved " + file_name(saving.path), false, showing(saving.path));
      });
}

/// The frames that play, without those left out, in order.
std::vector<int> frames_of(const Session& session) {
  const FrameRange range = play_range(session.playback, frame_count(session));
  std::vector<int> frames;
  const auto add = [&](int frame) {
    if (frame >= range.first && frame <= range.last) frames.push_back(frame);
  };
  if (session.document.takes.empty())
    for (int frame = 0; frame < frame_count(session); ++frame) add(frame);
  else
    for (const MomentBetween& moment : moments_of(session, session.selected_take))
      add(moment.share < 0.5f ? moment.before : moment.after);
  return frames;
}

void save_video(Call& c) {
  const Saving saving = saving_of(c);
  const std::vector<int> frames = frames_of(c.session);
  US_CHECK(!frames.empty(), "there is nothing to show yet");
  const std::string suffix = file_suffix(saving.path);
  US_CHECK(suffix.empty() || suffix == ".mp4", suffix, " is not a video: .mp4, or a folder for pictures");
  const double fps = c.session.source.fps;
  remember_folder(c.studio, saving.path);
  c.studio.jobs().start(
      "Saving " + file_name(saving.path),
      [saving, frames, fps, session = copied(c.session)](JobControl& control) {
        Stage stage(std::move(*session), saving);
        const auto [width, height] = std::pair(saving.options.size.width, saving.options.size.height);
        render::VideoWriter writer(saving.path, {width, height, fps});
        std::future<void> writing;  // of the frame before, while the next is drawn
        for (size_t i = 0; i < frames.size(); ++i) {
          control.check();
          control.progress(static_cast<float>(i) / static_cast<float>(frames.size()));
          render::Image picture = stage.picture(frames[i]);
          if (writing.valid()) writing.get();
          writing = std::async(std::launch::async,
                               [&writer, picture = std::move(picture)] { writer.push(picture); });
        }
        writing.get();
        control.check();
        writer.finish();
      },
      [&studio = c.studio, saving] {
        studio.notify("Saved " + file_name(saving.path), false, showing(saving.path));
      });
}

/// With the program that the system has for it.
void open_with_system(const std::string& path) {
  constexpr const char* kScript =
      "command -v xdg-open >/dev/null || exit 1; xdg-open \"$1\" </dev/null >/dev/null 2>&1 &";
  const char* const arguments[] = {"sh", "-c", kScript, "sh", path.c_str(), nullptr};
  pid_t pid = 0;
  int status = 1;
  const bool began =
      ::posix_spawn(&pid, "/bin/sh", nullptr, nullptr, const_cast<char* const*>(arguments), environ) == 0;
  US_CHECK(began && ::waitpid(pid, &status, 0) == pid && status == 0, path,
           ": cannot be shown, xdg-open is not installed");
}

/// Opens the folder of a file in the system's file manager.
void show_file(Call& c) {
  const fs::path path = c.path(0);
  const std::string folder = path.parent_path().string();
  US_CHECK(fs::is_directory(folder), folder, ": there is no such folder");
  open_with_system(folder);
  c.studio.notify(file_name(c.path(0)) + " is in " + folder);  // xdg-open may know no program for folders
}

}  // namespace

void add_window_commands(Commands& commands, ui::Workspace& workspace) {
  commands.add(
      {"dialog.open", "Open dialog",
       "open|open_source|blend_with|map_folder|source_times|source_markers|open_target|replace_target|open_"
       "document|save_as|export|csv|"
       "picture|video|compare|settings|about|keys|here|open_study|save_study|study_files|"
       "study_animation|study_motion|study_target|study_answers|study_table|study_csv|study_jspsych|"
       "study_psychopy|study_stimuli|study_web|study_run|none"},
      [&workspace](Call& c) {
        US_CHECK(c.arguments.size() == 1, "dialog.open needs the name of a dialog");
        workspace.open_dialog(c.session, c.arguments[0]);
      });
  commands.add({"panel.show", "Panel", "NAME on|off|toggle"}, [&workspace](Call& c) {
    const bool shown = ui::panel_shown(c.session, c.word(0, "panel"));
    workspace.show_panel(c.session.settings, c.arguments[0], c.switched(1, shown));
  });
  commands.add(
      {"menu.open", "Menus", "[file|edit|view|target|tools|study|window|help]"},
      [&workspace](Call& c) { workspace.open_menu(c.session, c.arguments.empty() ? "" : c.arguments[0]); });
  commands.add({"help.keys", "Help"}, [&workspace](Call& c) { workspace.open_dialog(c.session, "keys"); });
  commands.add({"help.here", "Help for what the pointer is on"},
               [&workspace](Call& c) { workspace.open_dialog(c.session, "here"); });
  commands.add({"file.show", "Show in folder", "PATH"}, show_file);
  commands.add({"file.open", "Open with its program", "PATH"}, [](Call& c) {
    const std::string path = c.path(0);
    US_CHECK(fs::exists(path), path, ": there is no such file");
    open_with_system(path);
  });
  add_study_render(commands);
  commands.add({"picture.save", "Save picture", "PATH.png [WIDTH HEIGHT] [transparent] [view|all]"},
               save_picture);
  commands.add({"video.save", "Save video", "PATH.mp4 or FOLDER [WIDTH HEIGHT] [view|all]"}, save_video);
}

}  // namespace understudy::app
