// The points of a cloud that are nearest to a place, whatever the distance.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// A k-d tree; it keeps the points. Any number of threads may ask at a time.
class PointTree {
 public:
  /// Throws Error without a point.
  explicit PointTree(Points points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;

  struct Near {
    int point;      ///< its row
    float squared;  ///< m^2
  };
  Near nearest(const Vec3& at) const;
  /// The k nearest, nearest first; fewer where there are fewer.
  void nearest(const Vec3& at, int k, std::vector<Near>& found) const;
  const Points& points() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy
