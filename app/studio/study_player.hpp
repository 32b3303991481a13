// Shows a study to one participant on a surface: screens, clips, input, until they are done or leave.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/studio/surface.hpp"
#include "app/study/study_run.hpp"
#include "render/video_reader.hpp"
#include "ui/gui/draw_pass.hpp"
#include "ui/gui/gui.hpp"
#include "ui/runner/run_screen.hpp"

namespace understudy::app {

/// Use from one thread.
class StudyPlayer {
 public:
  /// stimuli: the folder with clips/, as check_clips() wants it.
  StudyPlayer(StudyRun& run, std::string stimuli, std::unique_ptr<Surface> surface);
  ~StudyPlayer();

  /// Takes input and draws. now_s: of a clock that never jumps; input is waited for up to `patience_s`.
  /// Throws Error where a clip cannot be played.
  void frame(double now_s, double patience_s);
  /// Frames by the clock until the participant is done or leaves.
  void run();
  bool is_over() const { return state_.leaves; }

  Surface& surface() { return *surface_; }
  const ui::Gui& gui() const { return gui_; }

 private:
  struct Clip;
  void follow_clip(double now_s);
  void show_picture();
  void draw(double now_s, const std::vector<render::InputEvent>& events);
  double patience_s() const;

  StudyRun& run_;
  std::string stimuli_;
  std::unique_ptr<Surface> surface_;
  ui::Gui gui_;
  ui::DrawPass pass_;
  ui::RunScreenState state_;
  std::unique_ptr<Clip> clip_;  ///< while it plays
  std::unique_ptr<render::gl::Texture> texture_;
  double last_s_ = 0;
  int unsettled_ = 0;  ///< frames until widgets are at rest
};

}  // namespace understudy::app
