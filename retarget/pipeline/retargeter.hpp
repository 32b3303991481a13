// The pipeline in one piece: push a scan, get the target in the source's pose.
#pragma once

#include <optional>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/pipeline/motion_style.hpp"
#include "retarget/pipeline/observer.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy {

/// An observer, a style where there is one, and a performer. One thread at a time.
class Retargeter {
 public:
  /// With a transfer and a deformer it needs a target; without, it repairs and smooths the source alone.
  explicit Retargeter(Networks networks, const RetargetOptions& options = {})
      : networks_(std::move(networks)),
        options_(options),
        observer_(networks_.extractor),
        styled_(networks_.style, options.filter) {
    if (!networks_.transfer && !networks_.deformer) performer_.emplace(options);
  }
  /// Starts anew with a target. Throws Error when it cannot be bound, or has to be looked at and there is no
  /// extractor.
  void set_target(const Mesh& mesh) {
    US_CHECK(networks_.extractor, "the pipeline has no skeleton extractor");
    const auto& extractor = networks_.rest_extractor ? networks_.rest_extractor : networks_.extractor;
    set_target(prepare_target(mesh, *extractor));
  }
  void set_target(Target target) {
    performer_.emplace(std::move(target), networks_.transfer, networks_.deformer, options_);
    restart_source();
  }
  /// Starts the source anew, same target.
  void restart() {
    performer().restart();
    restart_source();
  }

  /// The target's frame for the source's scan, dt seconds after the one before; see Performer::perform.
  /// Throws Error without a target, and where the style lets frames come later.
  PerformedFrame push(const Mesh& scan, float dt) { return push(observer_.observe(scan, dt), dt); }
  /// The same of what was observed elsewhere, or by the observer below.
  PerformedFrame push(const Observation& seen, float dt) {
    send(seen, dt);
    std::optional<PerformedFrame> frame = next();
    US_CHECK(frame, "the style lets frames come later");
    return std::move(*frame);
  }
  /// The same in two steps, for any style: frames go in,
  void send(const Observation& seen, float dt) { styled_.push(seen, dt); }
  void finish() { styled_.finish(); }  ///< and after the last one this,
  /// and come out in their order; none: it needs more, or has given all. Throws Error without a target.
  std::optional<PerformedFrame> next() {
    const std::optional<TimedObservation> styled = styled_.pop();
    if (!styled) return std::nullopt;
    return performer().perform(styled->seen, styled->dt);
  }

  /// Seconds by which the style lets frames come later; 0: at once.
  float lag_s() const { return styled_.lag_s(); }
  Observer& observer() { return observer_; }
  /// Null: it takes given skeletons alone.
  const std::shared_ptr<SkeletonExtractor>& extractor() const { return networks_.extractor; }
  /// Throws Error without a target.
  Performer& performer() {
    US_CHECK(performer_, "there is no target yet");
    return *performer_;
  }

 private:
  void restart_source() {
    observer_.restart();
    styled_.restart();
  }

  Networks networks_;
  RetargetOptions options_;
  Observer observer_;
  StyledStream styled_;
  std::optional<Performer> performer_;
};

}  // namespace understudy
