// How late the frames of a live stream are, and how many there were.
#pragma once

#include <cstdint>
#include <string>

#include "app/run/latency.hpp"
#include "app/run/source.hpp"

namespace understudy::app {

class LiveFigures {
 public:
  /// A frame of the stream has just gone out: milliseconds since it was captured; 0 where nothing came in its
  /// time.
  double add(const ScanFrame& frame);
  /// "1800 frames and 3 in whose time nothing came, 2 dropped; from capture to wire 21.3 ms (median), 30.1 ms
  /// (p95), 80.2 ms (most)".
  std::string sentence() const;
  int64_t dropped() const { return dropped_; }
  bool any() const { return ms_.count() > 0; }
  const Histogram& ms() const { return ms_; }
  double most_ms() const { return most_ms_; }

 private:
  Histogram ms_;
  double most_ms_ = 0;
  int64_t missing_ = 0, dropped_ = 0;
};

}  // namespace understudy::app
