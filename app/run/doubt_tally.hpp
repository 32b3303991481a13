// How far a performance can be believed, as reports tell it.
#pragma once

#include <cstdint>

#include "app/run/report.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy::app {

/// Sums up frames as they come, in constant memory.
class DoubtTally {
 public:
  void add(const PerformedFrame& frame);
  /// {"flagged_share", "made_share": of all frames; "made_mm": the largest doubt of those made; "joints_mm":
  /// the mean expected error of extracted joints in frames that could be used}. The last is left out where
  /// nothing was extracted.
  Json json() const;

 private:
  int64_t frames_ = 0, flagged_ = 0, made_ = 0, extracted_ = 0;
  double made_m_ = 0, joints_m_ = 0;
};

}  // namespace understudy::app
