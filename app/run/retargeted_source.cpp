#include "app/run/retargeted_source.hpp"

#include <utility>

#include "app/run/keypoint_source.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

Observation observed(Observer& observer, const SourceFrame& frame, float dt) {
  if (!frame.usable) return observer.skip(frame.problem, dt);
  if (!frame.skeleton) return observer.observe(frame.mesh, dt);
  Observation seen = observer.observe(*frame.skeleton, dt);
  seen.points = frame.mesh.vertices.rows();
  seen.doubt_m = frame.doubt_m;
  return seen;
}

void look_with(Retargeter& retargeter, Source& source) {
  source.set_look([&retargeter](const Mesh& scan) { return retargeter.observer().look(scan); });
}

RetargetedSource::RetargetedSource(Source& source, Retargeter& retargeter, const SourceOptions& options,
                                   SourceTools tools)
    : source_(source),
      retargeter_(retargeter),
      name_(options.path),
      edits_(options.complete > 0 ? ScanEdits() : options.edits),
      cut_(retargeter.extractor(), is_keypoint_source(options) ? without_people(options) : options) {
  retargeter_.restart();
  if (retargeter_.lag_s() > 0)
    log::info(name_ + printed(": each frame comes %.1f s later, for its style",
                              static_cast<double>(retargeter_.lag_s())));
  look_with(retargeter_, source_);
  tools.extractor = [this] { return retargeter_.extractor(); };
  source_.set_tools(tools);
}

/// Reads a frame and lets it be styled. False at the end.
bool RetargetedSource::read(const std::optional<Joints>& known) {
  const auto began = std::chrono::steady_clock::now();
  auto scan = source_.next();
  if (!scan) return false;
  if (scan->usable && !edits_.empty()) scan->mesh = understudy::apply(edits_, scan->mesh);
  if (!known) cut_.apply(*scan, source_, ++read_);
  RetargetedFrame frame;
  frame.times.read = ms_since(began);
  const float dt = static_cast<float>(1 / source_.fps());
  Observer& observer = retargeter_.observer();
  Extraction given;
  if (known) given.joints = *known;
  const Observation seen = known ? observer.observe(given, scan->mesh, dt) : observed(observer, *scan, dt);
  if (!known && scan->usable && !scan->skeleton) cut_.tell(seen);
  if (!scan->usable && problem_.empty()) problem_ = scan->problem;
  if (!seen.warning.empty()) doubt_ = seen.warning;
  if (scan->usable && !scan->skeleton && !refusal(seen).empty()) ++unrecognised_;
  retargeter_.send(seen, dt);
  frame.times.extract = seen.extract_ms;
  frame.times.total = ms_since(began);
  frame.scan = std::move(*scan);
  waiting_.push_back(std::move(frame));
  return true;
}

std::optional<RetargetedFrame> RetargetedSource::next(const std::optional<Joints>& known) {
  for (;;) {
    const auto began = std::chrono::steady_clock::now();
    std::optional<PerformedFrame> result = retargeter_.next();
    if (!result && ended_) return std::nullopt;
    if (!result) {
      ended_ = !read(known);
      if (ended_) retargeter_.finish();
      continue;
    }
    RetargetedFrame frame = std::move(waiting_.front());
    waiting_.pop_front();
    frame.result = std::move(*result);
    frame.times.total += ms_since(began);
    frame.times.transfer = frame.result.transfer_ms;
    frame.times.deform = frame.result.deform_ms;
    frame.index = frames_++;
    flagged_ += frame.result.flagged ? 1 : 0;
    count_limbs(frame.result);
    return frame;
  }
}

void RetargetedSource::count_limbs(const PerformedFrame& frame) {
  if (frame.flagged) return;
  for (size_t k = 0; k < seen_.size(); ++k) seen_[k] += frame.limbs[k] == LimbSight::Seen ? 1 : 0;
  const std::string unseen = told_.push(frame.limbs);
  if (!unseen.empty()) log::warn(name_ + ": " + unseen);
}

void RetargetedSource::check_used() const {
  const std::string advice =
      std::string("; where a scan holds a floor or a second person, ") + kCleaning + " take them out";
  const std::string missing = frames_ > flagged_ ? "" : cut_.missing();
  US_CHECK(missing.empty(), name_, ": ", missing);
  const std::string why = unrecognised_ > 0 ? "no person is recognised in it" + advice : problem_;
  US_CHECK(frames_ > flagged_, name_, ": no frame in it could be used", why.empty() ? "" : ": ", why);
  if (unrecognised_ == 0 && doubt_.empty()) return;
  std::string sentence = name_ + ": ";
  if (unrecognised_ > 0)
    sentence += "no person recognised in " + std::to_string(unrecognised_) + " of " +
                std::to_string(frames_) + " frames";
  if (!doubt_.empty()) sentence += (unrecognised_ > 0 ? ", and it " : "") + doubt_;
  log::warn(sentence + advice);
}

}  // namespace understudy::app
