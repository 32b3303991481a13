// The views: panes with what the session holds, drawn by the renderer, and what the mouse does in them.
#pragma once

#include <memory>

#include "app/session/commands.hpp"
#include "app/session/frame_cache.hpp"
#include "app/session/session.hpp"
#include "ui/gui/ui.hpp"

namespace understudy::ui {

/// Owns the pictures of the panes. Make, use and destroy it with one GL context current (a null one will do).
class Views {
 public:
  Views();
  ~Views();
  Views(const Views&) = delete;
  Views& operator=(const Views&) = delete;

  /// Fills what is left of the current window with the panes of the layout. Redraws a pane only when
  /// its content, camera or size has changed. Marks: "view.0" the source, "view.1" the first take
  /// ..., "view.wipe" the line of a wipe, "view.legend", "view.warning", "view.tip". Throws Error where the
  /// context's complaints are fatal.
  void draw(const app::Session& session, app::FrameCache& cache, app::CommandQueue& queue, Ui& ui);

  /// Drops everything shown: the document was closed.
  void forget();
  /// Whether something is still being made or was drawn as a draft only: draw again soon.
  bool waiting() const;
  /// Whether the surface of this take was in the last frame drawn: as loaded, in T-pose or performing.
  bool shows_take(int k) const;
  /// Grows when the background has made something to draw that is not part of the session.
  int64_t arrived() const;
  /// Pictures of panes drawn since the start; for tests and figures.
  int64_t drawn() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::ui
