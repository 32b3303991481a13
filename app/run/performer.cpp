#include "app/run/performer.hpp"

#include "retarget/base/clock.hpp"

namespace understudy::app {

Performer::Performer(Source& source, Target target, Networks networks, const RetargetOptions& options)
    : source_(source), retargeter_(std::move(networks), options) {
  retargeter_.set_target(std::move(target));
}

std::optional<PerformedFrame> Performer::next() {
  return next(nullptr);
}

std::optional<PerformedFrame> Performer::next(const Joints& oracle) {
  Extraction extraction;
  extraction.joints = oracle;
  return next(&extraction);
}

std::optional<PerformedFrame> Performer::next(const Extraction* oracle) {
  const auto began = std::chrono::steady_clock::now();
  auto scan = source_.next();
  if (!scan) return std::nullopt;
  PerformedFrame frame;
  frame.times.read = ms_since(began);
  const float dt = static_cast<float>(1 / source_.fps());
  if (oracle) {
    Extraction known = *oracle;
    known.sole_height = sole_height(known.joints, scan->mesh.vertices);
    const BodyGirth girth = measure_girth(known, scan->mesh.vertices);
    frame.result = retargeter_.push(known, dt, &girth);
  } else if (scan->skeleton) {
    frame.result = retargeter_.push(*scan->skeleton, dt);
  } else {
    frame.result = retargeter_.push(scan->mesh, dt);
  }
  frame.times.total = ms_since(began);
  frame.times.extract = frame.result.ms.extract;
  frame.times.transfer = frame.result.ms.transfer;
  frame.times.deform = frame.result.ms.deform;
  if (!frame.result.flagged) last_seen_ = frame.result.source.joints;
  frame.source_joints = last_seen_;
  frame.scan = std::move(*scan);
  return frame;
}

}  // namespace understudy::app
