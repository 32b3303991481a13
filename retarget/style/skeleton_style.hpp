// An engine of styles as a stage of the pipeline: skeletons in, exact skeletons out.
#pragma once

#include <deque>
#include <memory>

#include "retarget/pipeline/motion_style.hpp"
#include "retarget/style/pose_style.hpp"
#include "retarget/style/standing_feet.hpp"
#include "retarget/style/style_frames.hpp"
#include "retarget/style/styled_root.hpp"

namespace understudy {

/// StyleFrames styled by the engine; between source and styled along the shortest arc by the strength; and
/// the path that leads to.
class SkeletonStyle final : public MotionStyle {
 public:
  SkeletonStyle(std::unique_ptr<PoseStyle> engine, float strength);
  void reset() override;
  void push(const Extraction& seen, float dt) override;
  std::optional<Extraction> pop() override;
  void finish() override { engine_->finish(); }
  float lag_s() const override { return engine_->lag_s(); }

 private:
  struct Waiting {
    StyleFrame frame;
    Extraction seen;
  };

  std::unique_ptr<PoseStyle> engine_;
  float strength_;
  StyleFrames frames_;
  std::deque<Waiting> waiting_;
  StyledRoot root_;
  StandingFeet feet_;
};

/// From `source` towards `styled` by this much, each along its shortest arc: 0 the source, 1 the styled,
/// beyond it goes on.
Rotations by_strength(const Rotations& source, const Rotations& styled, float strength);

}  // namespace understudy
