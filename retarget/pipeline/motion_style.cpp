#include "retarget/pipeline/motion_style.hpp"

#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

void StyleChoice::choose(const std::string& word) {
  const bool is_path =
      word.find('/') != std::string::npos || file_suffix(word) == ".json" || file_suffix(word) == ".weights";
  name = is_path ? "" : word;
  file = is_path ? word : "";
}

StyledStream::StyledStream(std::shared_ptr<MotionStyle> style, const JointFilterOptions& filter)
    : style_(std::move(style)), filter_(filter) {
  restart();
}

void StyledStream::restart() {
  if (style_) style_->reset();
  unseen_.reset();
  filter_.reset();
  waiting_.clear();
  waited_ = 0;
}

void StyledStream::push(const Observation& seen, float dt) {
  Waiting next{{seen, dt}, false};
  waited_ += dt;
  if (style_ && refusal(seen).empty()) {
    const Extraction repaired = filter_.push(unseen_.push(seen, waited_), waited_);
    next.seen.problem = failure_of([&] { style_->push(repaired, waited_); });
    next.seen.unstyled = Observation::Unstyled{repaired.joints, unseen_.limbs(), unseen_.feet()};
    next.is_styled = next.seen.problem.empty();
    waited_ = 0;
  }
  waiting_.push_back(std::move(next));
  if (style_ && style_->lag_s() > 0 && waited_ > style_->lag_s() && waiting_.front().is_styled) settle();
}

/// All frames that the style holds back come; it begins anew.
void StyledStream::settle() {
  style_->finish();
  for (Waiting& one : waiting_) {
    if (!one.is_styled) continue;
    if (std::optional<Extraction> styled = style_->pop())
      static_cast<Extraction&>(one.seen) = std::move(*styled);
    one.is_styled = false;
  }
  style_->reset();
}

std::optional<TimedObservation> StyledStream::pop() {
  if (waiting_.empty()) return std::nullopt;
  Waiting& next = waiting_.front();
  if (next.is_styled) {
    std::optional<Extraction> styled = style_->pop();
    if (!styled) return std::nullopt;
    static_cast<Extraction&>(next.seen) = std::move(*styled);
  }
  TimedObservation out = std::move(next);
  waiting_.pop_front();
  return out;
}

void StyledStream::finish() {
  if (style_) style_->finish();
}

}  // namespace understudy
