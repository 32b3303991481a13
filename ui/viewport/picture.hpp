// Pictures of the views for files and videos, in any size and the best quality; waits for every part.
#pragma once

#include <map>

#include "app/session/frame_cache.hpp"
#include "app/session/session.hpp"
#include "render/renderer.hpp"
#include "ui/viewport/scene_builder.hpp"
#include "ui/viewport/target_look.hpp"

namespace understudy::ui {

struct PictureOptions {
  int pane = -1;  ///< as View::active_pane; -1: all of them, as the layout has them
  render::PixelSize size{1600, 1000};
  bool transparent = false;  ///< without the background
  bool legend = true;        ///< what the colours mean, at the bottom left
};

/// Makes pictures of what the views show at the session's frame. Make, use and destroy it with one GL context
/// current; keep it for all pictures of a video.
class PictureMaker {
 public:
  /// Waits for the cache until every part is ready. Without frames: the empty stage. Throws Error for a pane
  /// that does not exist.
  render::Image picture(const app::Session& session, app::FrameCache& cache,
                        const PictureOptions& options = {});

 private:
  render::Image one(const app::Session& session, app::FrameCache& cache, const PaneContent& pane,
                    const render::Camera& camera, const PictureOptions& options);
  render::Image wiped(const app::Session& session, app::FrameCache& cache,
                      const std::vector<PaneContent>& panes, const PictureOptions& options);

  render::Renderer renderer_;
  TargetLooks looks_;
  std::map<int, SceneMemory> memories_;  // by PaneContent::number
};

}  // namespace understudy::ui
