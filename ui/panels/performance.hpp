// How the selected target performs: its style, and its tempo. Sections: inspector.performance,
// inspector.tempo. Marks: performance.style, .strength, .posture, .size, .liveliness, .open, .compare,
// .teach, .teaching (the job);
// tempo.by (.0 the source's, .1 the body's, .2 a number), tempo.length, .anticipation, .stroke, .recovery,
// .spread, .of_style, .mark, .falls (the hint's button).
#pragma once

#include <vector>

#include "ui/panels/panel.hpp"
#include "ui/widgets/timeline_track.hpp"

namespace understudy::ui {

void draw_performance(const app::Session& session, PanelContext& context);

/// The phases of movements of the selected take, as bars of the timeline; of takes with a tempo of their own.
struct PhaseBands {
  std::vector<TrackBand> bands;
  void follow(const app::Session& session);

 private:
  int take_ = -1;
  int64_t generation_ = -1;
  size_t frames_ = 0;
};

}  // namespace understudy::ui
