// The studio with its interface: session, panels and views on one surface.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/studio.hpp"
#include "app/studio/previews.hpp"
#include "app/studio/study_pictures.hpp"
#include "app/studio/surface.hpp"
#include "ui/gui/draw_pass.hpp"
#include "ui/gui/gui.hpp"

namespace understudy::ui {
class Views;
class Workspace;
}  // namespace understudy::ui

namespace understudy::app {

struct ApplicationOptions {
  std::string marks_file;      ///< written whenever it changes: places of widgets and facts; empty: none
  bool remember_size = false;  ///< of the window, in the settings
  bool echo_log = true;        ///< also pass messages on to the previous log
};

/// The events that a recording gets.
struct InputListener {
  virtual ~InputListener() = default;
  /// Before each frame: the input since the last one. Also called without events.
  virtual void input(double dt, const std::vector<render::InputEvent>& events, const Session& session) = 0;
  /// A command that the interface pushed.
  virtual void command(const std::string& name, const Arguments& arguments) = 0;
};

/// Use from one thread. While it lives, log messages go to Session::log.
class Application {
 public:
  Application(StudioServices services, std::unique_ptr<Surface> surface, ApplicationOptions options = {});
  ~Application();
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  Studio& studio() { return *studio_; }
  const Session& session() const { return studio_->session(); }
  Surface& surface() { return *surface_; }
  ui::Gui& gui() { return *gui_; }
  ui::Workspace& workspace() { return *workspace_; }
  /// Places that the pointer may go to: named widgets, and joints in the views (joint.PANE.NAME).
  std::vector<ui::Mark> marks() const;
  std::optional<ui::Mark> find(const std::string& name) const;
  /// The widget that keys are about, "" for none.
  std::string focus() const { return gui_->ui().focus().name(); }
  /// Whether something on the screen is still being made.
  bool waiting() const;
  void observe(InputListener* observer) { observer_ = observer; }

  /// Takes input, runs the commands it leads to and draws, `dt` seconds after the last step.
  void frame(double dt);
  /// Sleeps until there is something to do or show, then takes a step. For windows.
  void step();
  /// Steps until the user quits.
  void run();
  /// Frames drawn so far.
  int64_t drawn() const { return drawn_; }
  /// Whether the frame drawn last shows the surface of this take.
  bool shows_take(int k) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct LogBox;
  /// Does a part of a frame. What goes wrong is shown in a dialog and the studio goes on; false then.
  bool attempt(const std::function<void()>& part);
  void tick_and_draw(double tick_dt, const std::function<void()>& drawing);
  void take_log();
  void draw(double dt, const std::vector<render::InputEvent>& events);
  void handle(const render::InputEvent& event);
  void draw_interface(double dt, const std::vector<render::InputEvent>& events);
  void show_previews();
  ui::TrialPicture trial_picture(float share);
  std::unique_ptr<ui::Workspace> make_workspace();
  void run_queue();
  void show_state();
  void write_marks();
  double patience_s() const;
  double fastest_s() const;
  bool due() const;
  int64_t arrived() const;
  std::string fingerprint(int64_t arrived) const;

  ApplicationOptions options_;
  std::unique_ptr<Surface> surface_;
  std::shared_ptr<LogBox> log_;
  std::unique_ptr<Studio> studio_;
  std::unique_ptr<ui::Gui> gui_;
  std::unique_ptr<ui::DrawPass> pass_;
  std::unique_ptr<ui::Views> views_;
  std::unique_ptr<Previews> previews_;
  std::unique_ptr<StudyPictures> study_pictures_;
  std::unique_ptr<ui::Workspace> workspace_;
  CommandQueue queue_;
  InputListener* observer_ = nullptr;
  Clock::time_point ticked_at_, drawn_at_, input_at_;
  double drawing_took_s_ = 0;  // the last frame
  size_t samples_ = 0;         ///< cards on the start screen
  float frame_rate_ = 0;
  std::string on_screen_;  ///< fingerprint of what was drawn last
  std::string marks_;      ///< what the marks file holds
  int frames_wanted_ = 3;  ///< until the widgets have settled
  int64_t drawn_ = 0;
  int failures_ = 0;  ///< frames on end in which something went wrong
};

}  // namespace understudy::app
