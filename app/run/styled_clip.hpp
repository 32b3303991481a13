// Somebody who moves in a style, on their own bones: what `style` writes, and what is taught and judged.
#pragma once

#include <functional>
#include <vector>

#include "app/run/evaluator.hpp"
#include "app/run/source.hpp"
#include "app/run/tempo_choice.hpp"
#include "retarget/pipeline/performer.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy::app {

struct StyledClip {
  double fps = 30;
  Joints rest = Joints::Zero();
  std::vector<Pose> poses;
  float path_m = 0, apart_m = 0;  ///< length of the source's path; how far from its end the styled one ends

  std::vector<Rotations> local() const;
};

/// Called after each frame, may throw. `of`: frames of the source, 0 where nobody knows.
using ClipStep = std::function<void(int64_t done, int64_t of)>;

/// Goes through the source once, in the style of the networks where they have one. Frames that cannot be used
/// repeat the one before. Throws Error where none can.
StyledClip styled_clip(const SourceOptions& source, const Networks& networks, const RetargetOptions& how,
                       const SourceTools& tools = {}, const ClipStep& step = {});

/// Its poses at this tempo. legs_m: of who is to perform it, for the tempo "body"; 0: not told, an Error
/// there.
void give_tempo(TempoChoice choice, double legs_m, StyledClip& clip);

/// style_figures(), with jerk.
Metrics figures_of(const StyledClip& clip);

/// The upper one of the two in the middle; NaN where there is none.
double median_of(std::vector<double> values);

/// As an engine of styles is given it.
std::vector<StyleFrame> style_frames(const StyledClip& clip);

}  // namespace understudy::app
