#include "app/run/retargeted_source.hpp"

#include <utility>

#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {

Observation observed(Observer& observer, const SourceFrame& frame, float dt) {
  if (!frame.usable) return observer.skip(frame.problem, dt);
  if (!frame.skeleton) return observer.observe(frame.mesh, dt);
  Observation seen = observer.observe(*frame.skeleton, dt);
  seen.points = frame.mesh.vertices.rows();
  return seen;
}

RetargetedSource::RetargetedSource(Source& source, Retargeter& retargeter, std::string name)
    : source_(source), retargeter_(retargeter), name_(std::move(name)) {
  retargeter_.restart();
}

std::optional<RetargetedFrame> RetargetedSource::next(const std::optional<Joints>& known) {
  const auto began = std::chrono::steady_clock::now();
  auto scan = source_.next();
  if (!scan) return std::nullopt;
  RetargetedFrame frame;
  frame.times.read = ms_since(began);
  const float dt = static_cast<float>(1 / source_.fps());
  Observer& observer = retargeter_.observer();
  Extraction given;
  if (known) given.joints = *known;
  const Observation seen = known ? observer.observe(given, scan->mesh, dt) : observed(observer, *scan, dt);
  if (!seen.warning.empty()) log::warn(name_ + ": " + seen.warning);
  frame.result = retargeter_.push(seen, dt);
  frame.times.total = ms_since(began);
  frame.times.extract = seen.extract_ms;
  frame.times.transfer = frame.result.transfer_ms;
  frame.times.deform = frame.result.deform_ms;
  frame.scan = std::move(*scan);
  frame.index = frames_++;
  flagged_ += frame.result.flagged ? 1 : 0;
  return frame;
}

void RetargetedSource::check_used() const {
  US_CHECK(frames_ > flagged_, name_, ": no frame in it could be used");
}

}  // namespace understudy::app
