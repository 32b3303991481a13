// The screens of a study as a participant sees them: welcome, clip, questions, break, end.
#pragma once

#include <imgui.h>

#include <string>

#include "app/study/study_run.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// A picture of the clip; null: none yet.
struct ClipPicture {
  ImTextureID texture = nullptr;
  float width = 0, height = 0;  ///< pixels
};

/// What a frame of the screens needs and what came of it.
struct RunFrame {
  app::StudyRun& run;
  ClipPicture clip;
  double now_s = 0;  ///< of a clock that never jumps
};

/// Between frames.
struct RunScreenState {
  int marked = 0;          ///< the question that the number keys are about
  std::string problem;     ///< why answers could not be saved, until they are; empty: nothing
  bool wants_all = false;  ///< the participant would go on, and a question is not answered
  bool asks_to_leave = false;
  bool leaves = false;  ///< the participant is done here, or has left
};

/// Draws the screen and does what mouse and keys ask: 1 .. 9 choose at the marked question, the arrows mark
/// another, Enter goes on once all is answered,
/// R plays the clip again, Escape asks whether to leave. Marks: "run.begin",
/// "run.question.N.M", "run.replay", "run.continue", "run.leave", "run.stay". In a frame of the Gui.
void draw_run_screen(Ui& ui, RunScreenState& state, const RunFrame& frame);

/// Words and buttons for this background.
ThemeKind theme_upon(const Vec3& background);

}  // namespace understudy::ui
