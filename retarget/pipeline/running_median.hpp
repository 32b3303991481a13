// The median of the newest values seen, in bounded memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace understudy {

/// Keeps the newest `window` values and gives their median.
class RunningMedian {
 public:
  explicit RunningMedian(size_t window = 300) : window_(window) {}
  void clear() { values_.clear(), next_ = 0; }
  void push(float value) {
    if (values_.size() < window_) {
      values_.push_back(value);
    } else {
      values_[next_] = value;
      next_ = (next_ + 1) % window_;
    }
  }
  bool empty() const { return values_.empty(); }
  size_t count() const { return values_.size(); }
  /// 0 before the first value; of an even number the mean of the middle two.
  float value() const {
    if (values_.empty()) return 0;
    std::vector<float> sorted = values_;
    const size_t middle = sorted.size() / 2;
    std::nth_element(sorted.begin(), sorted.begin() + middle, sorted.end());
    const float upper = sorted[middle];
    if (sorted.size() % 2 == 1) return upper;
    return 0.5f * (upper + *std::max_element(sorted.begin(), sorted.begin() + middle));
  }

 private:
  size_t window_, next_ = 0;
  std::vector<float> values_;
};

}  // namespace understudy
