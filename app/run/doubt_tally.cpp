#include "app/run/doubt_tally.hpp"

#include <algorithm>

namespace understudy::app {

void DoubtTally::add(const PerformedFrame& frame) {
  ++frames_;
  flagged_ += frame.flagged;
  made_ += frame.observed.doubt_m > 0;
  made_m_ = std::max(made_m_, static_cast<double>(frame.observed.doubt_m));
  if (frame.flagged || (frame.confidence == 1).all()) return;  // a skeleton's own joints are all certain
  ++extracted_;
  double sum = 0;
  for (const float confidence : frame.confidence) sum += static_cast<double>(expected_error_for(confidence));
  joints_m_ += sum / kJointCount;
}

Json DoubtTally::json() const {
  const auto share = [this](int64_t part) {
    return frames_ > 0 ? static_cast<double>(part) / static_cast<double>(frames_) : 0.0;
  };
  Json json{{"flagged_share", share(flagged_)}, {"made_share", share(made_)}, {"made_mm", 1000 * made_m_}};
  if (extracted_ > 0) json["joints_mm"] = 1000 * joints_m_ / static_cast<double>(extracted_);
  return json;
}

}  // namespace understudy::app
