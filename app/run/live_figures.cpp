#include "app/run/live_figures.hpp"

#include <algorithm>

#include "retarget/base/clock.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

double LiveFigures::add(const ScanFrame& frame) {
  if (!frame.live) {
    ++missing_;
    return 0;
  }
  const double ms = ms_since(frame.live->captured);
  ms_.add(ms);
  most_ms_ = std::max(most_ms_, ms);
  dropped_ = frame.live->dropped;
  return ms;
}

std::string LiveFigures::sentence() const {
  return grouped(ms_.count()) + " frames and " + grouped(missing_) + " in whose time nothing came, " +
         grouped(dropped_) +
         printed(" dropped; from capture to wire %.1f ms (median), %.1f ms (p95), %.1f ms (most)",
                 ms_.quantile(0.5), ms_.quantile(0.95), most_ms_);
}

}  // namespace understudy::app
