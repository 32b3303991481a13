#include "app/run/latency.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr double kFirstMs = 1e-3, kRatio = 1.01;

}  // namespace

void Histogram::add(double ms) {
  const double place = std::floor(std::log(std::max(ms, kFirstMs) / kFirstMs) / std::log(kRatio));
  ++buckets_[std::min(place, static_cast<double>(buckets_.size() - 1))];
  ++count_;
  total_ms_ += ms;
}

void Histogram::add(const Histogram& other) {
  for (size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
  total_ms_ += other.total_ms_;
}

double Histogram::quantile(double q) const {
  if (count_ == 0) return 0;
  const int64_t wanted =
      std::max<int64_t>(1, static_cast<int64_t>(std::ceil(q * static_cast<double>(count_))));
  int64_t seen = 0;
  size_t i = 0;
  while (i + 1 < buckets_.size() && (seen += buckets_[i]) < wanted) ++i;
  return kFirstMs * std::pow(kRatio, static_cast<double>(i) + 0.5);
}

void Latency::add(const FrameTimes& t) {
  const std::array<double, 5> ms = {t.read, t.extract, t.transfer, t.deform, t.total};
  for (size_t i = 0; i < ms.size(); ++i) stages_[i].add(ms[i]);
}

void Latency::add(const Latency& other) {
  for (size_t i = 0; i < stages_.size(); ++i) stages_[i].add(other.stages_[i]);
}

std::string Latency::table() const {
  std::string text = "stage      p50 ms   p95 ms\n";
  for (int i = 0; i < 5; ++i)
    text += printed("%-9s %7.2f  %7.2f\n", kStages[i], quantile(i, 0.5), quantile(i, 0.95));
  const double seconds = stages_[4].total_ms() / 1000;
  return text + printed("%lld frames, %.1f frames/s\n", static_cast<long long>(frames()),
                        seconds > 0 ? static_cast<double>(frames()) / seconds : 0.0);
}

}  // namespace understudy::app
