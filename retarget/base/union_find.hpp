// Sets of numbers that are joined two by two (union-find).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace understudy {

/// 0 .. count - 1, each a set of its own at first. Many joins and look-ups take O(log count) each on average.
class UnionFind {
 public:
  explicit UnionFind(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The smallest number of the set that `i` is in.
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace understudy
