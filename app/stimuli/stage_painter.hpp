// Draws what a trial shows at a moment: pane by pane, or all side by side.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/stimuli/clip_plan.hpp"
#include "app/stimuli/stage.hpp"
#include "app/study/trials.hpp"
#include "render/renderer.hpp"
#include "render/text.hpp"

namespace understudy::app {

/// A renderer for each pane: one that draws in many sizes by turns makes its buffers anew each time. Make,
/// use and destroy it with one context current.
class ClipRenderers {
 public:
  render::Renderer& of(size_t pane);

 private:
  std::vector<std::unique_ptr<render::Renderer>> all_;
};

/// Pictures of one stage. Keeps what several of them share: source and target are drawn once for all
/// conditions, and a run of a motion once for all its repetitions, as far as there is room. On the thread of
/// the renderers' context, which must outlive this.
class StagePainter {
 public:
  /// size: of a whole picture.
  StagePainter(const Study& study, std::shared_ptr<const Stage> stage, render::PixelSize size,
               ClipRenderers& renderers);

  /// The whole picture: panes, their labels, or the card.
  render::Image picture(const Trial& trial, const ClipMoment& moment);
  /// One pane of it without a label, or the card.
  render::Image pane_picture(const Trial& trial, size_t pane, const ClipMoment& moment);
  const std::vector<PaneView>& panes() const { return panes_; }
  /// What is in a pane, as it is drawn.
  render::Scene scene(const Trial& trial, size_t pane, const ClipMoment& moment) const;
  /// "Source", "Target", "Result"; of a pair "A" and "B".
  std::string label(size_t pane) const;
  /// Pictures of panes that were drawn, those that were kept not counted again.
  int64_t drawn() const { return drawn_; }

 private:
  using Picture = std::shared_ptr<const render::Image>;
  /// Of the source -1, of the target -2, else the condition.
  int subject(const Trial& trial, size_t pane) const;
  const MovingSurface& surface(int subject) const;
  Picture drawn_pane(const Trial& trial, size_t pane, const ClipMoment& moment);
  void forget_others(const Trial& trial);
  render::Image card(render::PixelSize size) const;

  Study study_;
  std::shared_ptr<const Stage> stage_;
  render::PixelSize size_;
  ClipRenderers& renderers_;
  render::Font font_;
  std::vector<PaneView> panes_;
  render::Image frame_;                             // background and labels
  render::Image border_;                            // between two panes
  std::map<std::pair<int, size_t>, Picture> kept_;  // by subject and its frame
  int64_t kept_bytes_ = 0, drawn_ = 0;
};

}  // namespace understudy::app
