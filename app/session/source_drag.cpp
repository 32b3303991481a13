#include "app/session/source_drag.hpp"

#include <algorithm>
#include <utility>

namespace understudy::app {
namespace {

constexpr int kRemembered = 300;  // frames after which the filter has forgotten all before
constexpr int kLongestRun = 240;  // frames made anew with every movement of the mouse

}  // namespace

SourceDrag::SourceDrag(const Session& session, int frame, int falloff)
    : frames_(session.source.frames),
      edits_(session.document.skeleton_edits),
      interval_(static_cast<float>(1 / session.source.fps)),
      frame_(frame),
      first_(std::max(0, frame - std::min(falloff, kLongestRun))) {
  const auto& takes = session.document.takes;
  before_.filter = JointFilter(retarget_options(takes.empty() ? Method{} : takes[0].method).filter);
  for (int t = std::max(0, first_ - kRemembered); t < first_; ++t) push(edits_, t, before_);
}

std::optional<Joints> SourceDrag::joints(const DragEdit& drag) const {
  std::vector<SkeletonEdit> edits = edits_;
  edits.push_back(drag);
  State state = before_;
  for (int t = first_; t < frame_; ++t) push(edits, t, state);
  return push(edits, frame_, state);
}

/// A frame through the stages; none where it is not used.
std::optional<Joints> SourceDrag::push(const std::vector<SkeletonEdit>& edits, int frame,
                                       State& state) const {
  const KeptSource& kept = frames_[frame];
  state.waited += interval_;
  if (kept.flagged) return std::nullopt;
  Extraction seen;
  seen.joints = kept.raw, seen.confidence = kept.raw_confidence, seen.exact = kept.exact;
  seen.visibility = kept.visibility;
  const float dt = std::exchange(state.waited, 0);
  return state.filter.push(state.unseen.push(understudy::apply(edits, seen, frame), dt), dt).joints;
}

}  // namespace understudy::app
