// Gets what a pane shows from the cache, and keeps what it showed until the next is there.
#pragma once

#include <deque>
#include <optional>

#include "ui/viewport/panes.hpp"
#include "ui/viewport/surface_values.hpp"
#include "ui/viewport/target_look.hpp"

namespace understudy::ui {

/// All that a pane needs of a frame, asked for at once; none while a part is still being made. Ghosts are
/// not waited for: those that are there.
std::optional<PanePictures> pictures_of(const app::Session& session, app::FrameCache& cache,
                                        const PaneContent& pane, int frame);

/// The look of a pane's first target where that stands in its T-pose, or as it came, instead of a frame; none
/// where it does not.
std::optional<std::shared_ptr<const TargetLook>> look_of_standing(const app::Session& session,
                                                                  TargetLooks& looks,
                                                                  const PaneContent& pane);

/// One for each pane.
class PictureKeeper {
 public:
  /// What to show now: of the frame shown, or of the newest frame that was asked for and is there.
  const PanePictures& update(const app::Session& session, app::FrameCache& cache, TargetLooks& looks,
                             const PaneContent& pane);
  const PanePictures& pictures() const { return pictures_; }
  bool waiting() const { return waiting_; }

 private:
  bool show_standing(const app::Session& session, TargetLooks& looks, const PaneContent& pane);
  void forget_others(const app::Session& session, const PaneContent& pane);

  PanePictures pictures_;
  std::deque<int> asked_;  // frames, the newest first
  std::vector<std::shared_ptr<const Target>> targets_;
  std::string source_;
  bool waiting_ = false;
};

/// Asks for the frames that playback comes to next, and for the neighbours of one that stands.
void prefetch(const app::Session& session, app::FrameCache& cache, const PaneContent& pane);

}  // namespace understudy::ui
