// How long the stages of a frame take: medians and 95th percentiles in constant memory.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace understudy::app {

/// Counts durations in buckets 1 % apart, from a microsecond to a quarter of an hour.
class Histogram {
 public:
  void add(double ms);
  /// The duration that a share of them stays below, q in 0..1; exact to 0.5 %. 0 when none was added.
  double quantile(double q) const;
  int64_t count() const { return count_; }
  double total_ms() const { return total_ms_; }
  void add(const Histogram& other);

 private:
  std::array<uint32_t, 2080> buckets_{};
  int64_t count_ = 0;
  double total_ms_ = 0;
};

/// Milliseconds one frame spent in each stage.
struct FrameTimes {
  double read = 0, extract = 0, transfer = 0, deform = 0, total = 0;
};

class Latency {
 public:
  static constexpr std::array<const char*, 5> kStages = {"read", "extract", "transfer", "deform", "total"};
  void add(const FrameTimes& times);
  void add(const Latency& other);
  /// Milliseconds of stage kStages[stage].
  double quantile(int stage, double q) const { return stages_[stage].quantile(q); }
  int64_t frames() const { return stages_[4].count(); }
  /// A table for people: a line a stage with p50 and p95, and frames per second.
  std::string table() const;

 private:
  std::array<Histogram, 5> stages_;
};

}  // namespace understudy::app
