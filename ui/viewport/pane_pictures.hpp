// Gets a pane's frames from the cache and keeps the last ones until the next are ready.
#pragma once

#include <deque>
#include <optional>

#include "ui/viewport/panes.hpp"
#include "ui/viewport/surface_values.hpp"
#include "ui/viewport/target_look.hpp"

namespace understudy::ui {

/// Everything that a pane needs for a frame, requested at once; none while a part is being made. Does not
/// wait for ghosts: takes those that are ready.
std::optional<PanePictures> pictures_of(const app::Session& session, app::FrameCache& cache,
                                        const PaneContent& pane, int frame);

/// The look of a pane's first target where the pane shows its T-pose, or the mesh as loaded, instead of a
/// frame; else none.
std::optional<std::shared_ptr<const TargetLook>> look_of_standing(const app::Session& session,
                                                                  TargetLooks& looks,
                                                                  const PaneContent& pane);

/// One for each pane.
class PictureKeeper {
 public:
  /// What to show now: the current frame, or the newest requested frame that is ready.
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

/// Requests the next frames of playback, or the neighbours of a still frame.
void prefetch(const app::Session& session, app::FrameCache& cache, const PaneContent& pane);

}  // namespace understudy::ui
