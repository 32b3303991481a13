// The pipeline in one piece: push a scan, get the target in the source's pose.
#pragma once

#include <optional>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/pipeline/observer.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy {

/// An observer and a performer. One thread at a time.
class Retargeter {
 public:
  /// With a transfer and a deformer it needs a target; without, it repairs and smooths the source alone.
  explicit Retargeter(Networks networks, const RetargetOptions& options = {})
      : networks_(std::move(networks)), options_(options), observer_(networks_.extractor) {
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
    observer_.restart();
  }
  /// Starts the source anew, same target.
  void restart() {
    performer().restart();
    observer_.restart();
  }

  /// The target's frame for the source's scan, dt seconds after the one before; see Performer::perform.
  /// Throws Error without a target.
  PerformedFrame push(const Mesh& scan, float dt) { return push(observer_.observe(scan, dt), dt); }
  /// The same of what was observed elsewhere, or by the observer below.
  PerformedFrame push(const Observation& seen, float dt) { return performer().perform(seen, dt); }

  Observer& observer() { return observer_; }
  /// Null: it takes given skeletons alone.
  const std::shared_ptr<SkeletonExtractor>& extractor() const { return networks_.extractor; }
  /// Throws Error without a target.
  Performer& performer() {
    US_CHECK(performer_, "there is no target yet");
    return *performer_;
  }

 private:
  Networks networks_;
  RetargetOptions options_;
  Observer observer_;
  std::optional<Performer> performer_;
};

}  // namespace understudy
