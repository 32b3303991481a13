// A picture of a trial as its clip shows it, for whoever looks through a study.
#pragma once

#include <memory>
#include <string>

#include "app/stimuli/stage_painter.hpp"

namespace understudy::app {

/// Keeps the last motion on the last target: moving about in its trials is quick, another one takes seconds.
/// Where that must not hold up drawing, make the stage (StageMaker) on a thread of its own, and draw it with
/// a StagePainter.
class TrialPictures {
 public:
  explicit TrialPictures(StimulusServices services);
  ~TrialPictures();
  /// The trial at a share (0..1) of its clip, cards too. A context must be current, always the same one, also
  /// at the end. Throws Error as check() and StageMaker::stage().
  render::Image picture(const Study& study, const Trial& trial, float share, render::PixelSize size);

 private:
  struct Kept;
  StimulusServices services_;
  ClipRenderers renderers_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace understudy::app
