// A joint of the source while it is dragged: the skeleton as it will be once the joint is let go.
#pragma once

#include <optional>

#include "app/session/session.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy::app {

/// The document's edits and a drag that is not yet one of them, applied to what was extracted, then repaired
/// and smoothed: the stages of the engine, from shortly before the first frame that the drag changes. Looks
/// at the session when it is made, not later.
class SourceDrag {
 public:
  /// Of a frame that is there, followed by `falloff` frames to each side.
  SourceDrag(const Session& session, int frame, int falloff);
  /// The frame's joints, world, metres; none where the frame cannot be used.
  /// The drag is of this frame and falloff.
  std::optional<Joints> joints(const DragEdit& drag) const;

 private:
  struct State {
    UnseenLimbs unseen;
    JointFilter filter;
    float waited = 0;  // seconds since the last good frame
  };
  std::optional<Joints> push(const std::vector<SkeletonEdit>& edits, int frame, State& state) const;

  SharedFrames<KeptSource> frames_;
  std::vector<SkeletonEdit> edits_;
  float interval_;  // seconds
  int frame_, first_;
  State before_;  // the frames before first_ have gone through it
};

}  // namespace understudy::app
